// Can this sphere be in the picture? And how does a pinhole become an OpenGL matrix?
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sim/render/pinhole_view.h"

namespace polnav::sim {

inline constexpr double kNear_m = 0.2;
inline constexpr double kFar_m = 600.0;

// Camera coordinates to clip coordinates. Row 0 of the frame buffer is the top of the image (no
// flip on the way out), so clip y points down. A pixel's centre is half a pixel from its corner.
[[nodiscard]] inline Eigen::Matrix4d ProjectionMatrix(const PinholeView& view) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m(0, 0) = 2.0 * view.fx_px / view.width_px;
  m(0, 2) = 2.0 * (view.cx_px + 0.5) / view.width_px - 1.0;
  m(1, 1) = 2.0 * view.fy_px / view.height_px;
  m(1, 2) = 2.0 * (view.cy_px + 0.5) / view.height_px - 1.0;
  m(2, 2) = (kFar_m + kNear_m) / (kFar_m - kNear_m);
  m(2, 3) = -2.0 * kFar_m * kNear_m / (kFar_m - kNear_m);
  m(3, 2) = 1.0;
  return m;
}

// The four side planes through the camera's centre and the near and far planes, in C.
class Frustum {
 public:
  explicit Frustum(const PinholeView& view) {
    const double left = (-0.5 - view.cx_px) / view.fx_px;
    const double right = (view.width_px - 0.5 - view.cx_px) / view.fx_px;
    const double top = (-0.5 - view.cy_px) / view.fy_px;
    const double bottom = (view.height_px - 0.5 - view.cy_px) / view.fy_px;
    inward_ = {Eigen::Vector3d(1.0, 0.0, -left).normalized(),
               Eigen::Vector3d(-1.0, 0.0, right).normalized(),
               Eigen::Vector3d(0.0, 1.0, -top).normalized(),
               Eigen::Vector3d(0.0, -1.0, bottom).normalized()};
  }

  [[nodiscard]] bool MayShow(const Eigen::Vector3d& center_C, double radius) const {
    if (center_C.z() < kNear_m - radius || center_C.z() > kFar_m + radius) return false;
    for (const Eigen::Vector3d& n : inward_) {
      if (n.dot(center_C) < -radius) return false;
    }
    return true;
  }

  // A cone of directions about the eye; direction_C: unit vector.
  [[nodiscard]] bool MayShowDirections(const Eigen::Vector3d& direction_C,
                                       double radius_rad) const {
    // The cone's cap on the unit sphere lies in a ball of this radius about its middle direction.
    const double reach = 2.0 * std::sin(0.5 * std::min(radius_rad, std::numbers::pi));
    if (direction_C.z() < -reach) return false;
    for (const Eigen::Vector3d& n : inward_) {
      if (n.dot(direction_C) < -reach) return false;
    }
    return true;
  }

 private:
  std::array<Eigen::Vector3d, 4> inward_;
};

}  // namespace polnav::sim
