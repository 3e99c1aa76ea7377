// Where on the sensor does a ray land?
//
// Brown-Conrady radial-tangential distortion in OpenCV's order k1 k2 p1 p2, on normalized image
// coordinates (x, y) = (X, Y) / Z. Monotonic only out to some radius; a lens of -0.17, 0.025 is so
// well beyond its corners.
#pragma once

#include <Eigen/Core>
#include <array>

#include "nav/api/calibration.h"

namespace polnav::sim {

[[nodiscard]] inline Eigen::Vector2d Distort(const std::array<double, 4>& k,
                                             const Eigen::Vector2d& xy) {
  const double x = xy.x();
  const double y = xy.y();
  const double r2 = xy.squaredNorm();
  const double radial = 1.0 + r2 * (k[0] + r2 * k[1]);
  return {x * radial + 2.0 * k[2] * x * y + k[3] * (r2 + 2.0 * x * x),
          y * radial + k[2] * (r2 + 2.0 * y * y) + 2.0 * k[3] * x * y};
}

// Newton's method; below 1e-12 after a few steps wherever Distort is monotonic.
[[nodiscard]] inline Eigen::Vector2d Undistort(const std::array<double, 4>& k,
                                               const Eigen::Vector2d& distorted) {
  Eigen::Vector2d xy = distorted;
  for (int i = 0; i < 20; ++i) {
    const double x = xy.x();
    const double y = xy.y();
    const double r2 = xy.squaredNorm();
    const double radial = 1.0 + r2 * (k[0] + r2 * k[1]);
    const double slope = 2.0 * (k[0] + 2.0 * r2 * k[1]);  // d radial / d(x, y) = slope (x, y)
    const double a = radial + slope * x * x + 2.0 * k[2] * y + 6.0 * k[3] * x;
    const double b = slope * x * y + 2.0 * k[2] * x + 2.0 * k[3] * y;  // symmetric
    const double d = radial + slope * y * y + 6.0 * k[2] * y + 2.0 * k[3] * x;
    const Eigen::Vector2d error = Distort(k, xy) - distorted;
    const double det = a * d - b * b;
    const Eigen::Vector2d step((d * error.x() - b * error.y()) / det,
                               (a * error.y() - b * error.x()) / det);
    xy -= step;
    if (step.squaredNorm() < 1e-26) break;
  }
  return xy;
}

// Pixel of a point in camera coordinates, z > 0.
[[nodiscard]] inline Eigen::Vector2d ProjectToPixel(const nav::CameraCalibration& camera,
                                                    const Eigen::Vector3d& p_C_m) {
  const Eigen::Vector2d xy = Distort(camera.distortion, p_C_m.head<2>() / p_C_m.z());
  return {camera.fx_px * xy.x() + camera.cx_px, camera.fy_px * xy.y() + camera.cy_px};
}

// Normalized coordinates of the ray behind a pixel.
[[nodiscard]] inline Eigen::Vector2d RayOfPixel(const nav::CameraCalibration& camera, double u_px,
                                                double v_px) {
  return Undistort(camera.distortion,
                   {(u_px - camera.cx_px) / camera.fx_px, (v_px - camera.cy_px) / camera.fy_px});
}

}  // namespace polnav::sim
