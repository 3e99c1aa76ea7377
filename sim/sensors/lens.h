// Where on the sensor does a ray land?
//
// The two models of nav::DistortionModel on normalized image coordinates (x, y) = (X, Y) / Z, so
// for rays before the camera only.
//   radtan       [Brown1971] monotonic out to some radius; a lens of -0.17, 0.025 is so well beyond
//                its corners
//   equidistant  [Kannala2006] monotonic out to some angle
// The inverses are Newton's method; below 1e-12 after a few steps wherever the model is monotonic.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "nav/api/calibration.h"

namespace polnav::sim {

[[nodiscard]] inline Eigen::Vector2d DistortRadTan(const std::array<double, 4>& k,
                                                   const Eigen::Vector2d& xy) {
  const double x = xy.x();
  const double y = xy.y();
  const double r2 = xy.squaredNorm();
  const double radial = 1.0 + r2 * (k[0] + r2 * k[1]);
  return {x * radial + 2.0 * k[2] * x * y + k[3] * (r2 + 2.0 * x * x),
          y * radial + k[2] * (r2 + 2.0 * y * y) + 2.0 * k[3] * x * y};
}

[[nodiscard]] inline Eigen::Vector2d UndistortRadTan(const std::array<double, 4>& k,
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
    const Eigen::Vector2d error = DistortRadTan(k, xy) - distorted;
    const double det = a * d - b * b;
    const Eigen::Vector2d step((d * error.x() - b * error.y()) / det,
                               (a * error.y() - b * error.x()) / det);
    xy -= step;
    if (step.squaredNorm() < 1e-26) break;
  }
  return xy;
}

// Distance from the centre, in focal lengths, of a ray at this angle from the axis.
[[nodiscard]] inline double EquidistantRadius(const std::array<double, 4>& k, double theta_rad) {
  const double t2 = theta_rad * theta_rad;
  return theta_rad * (1.0 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3]))));
}

[[nodiscard]] inline double EquidistantAngle(const std::array<double, 4>& k, double radius) {
  double theta = radius;
  for (int i = 0; i < 20; ++i) {
    const double t2 = theta * theta;
    const double slope =
        1.0 + t2 * (3.0 * k[0] + t2 * (5.0 * k[1] + t2 * (7.0 * k[2] + t2 * 9.0 * k[3])));
    const double step = (EquidistantRadius(k, theta) - radius) / slope;
    theta -= step;
    if (std::abs(step) < 1e-13) break;
  }
  return theta;
}

[[nodiscard]] inline Eigen::Vector2d Distort(const nav::CameraCalibration& camera,
                                             const Eigen::Vector2d& xy) {
  if (camera.model == nav::DistortionModel::kRadTan) return DistortRadTan(camera.distortion, xy);
  const double r = xy.norm();
  if (r == 0.0) return xy;
  return EquidistantRadius(camera.distortion, std::atan(r)) / r * xy;
}

// Not a number where an equidistant lens looks beside or behind the camera.
[[nodiscard]] inline Eigen::Vector2d Undistort(const nav::CameraCalibration& camera,
                                               const Eigen::Vector2d& distorted) {
  if (camera.model == nav::DistortionModel::kRadTan) {
    return UndistortRadTan(camera.distortion, distorted);
  }
  const double radius = distorted.norm();
  if (radius == 0.0) return distorted;
  const double theta = EquidistantAngle(camera.distortion, radius);
  if (!(theta >= 0.0 && theta < 0.5 * M_PI)) return Eigen::Vector2d::Constant(std::nan(""));
  return std::tan(theta) / radius * distorted;
}

// Pixel of a point in camera coordinates, z > 0.
[[nodiscard]] inline Eigen::Vector2d ProjectToPixel(const nav::CameraCalibration& camera,
                                                    const Eigen::Vector3d& p_C_m) {
  const Eigen::Vector2d xy = Distort(camera, p_C_m.head<2>() / p_C_m.z());
  return {camera.fx_px * xy.x() + camera.cx_px, camera.fy_px * xy.y() + camera.cy_px};
}

// Normalized coordinates of the ray behind a pixel.
[[nodiscard]] inline Eigen::Vector2d RayOfPixel(const nav::CameraCalibration& camera, double u_px,
                                                double v_px) {
  return Undistort(camera,
                   {(u_px - camera.cx_px) / camera.fx_px, (v_px - camera.cy_px) / camera.fy_px});
}

}  // namespace polnav::sim
