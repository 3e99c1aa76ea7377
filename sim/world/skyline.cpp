#include "sim/world/skyline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace polnav::sim {

std::size_t Skyline::CellAt(double angle_rad) {
  const double turns = angle_rad / (2.0 * std::numbers::pi);
  const auto cell = static_cast<std::size_t>((turns - std::floor(turns)) * kCells);
  return std::min(kCells - 1, cell);
}

void Skyline::Raise(const Cylinder& thing) {
  const double height = thing.top_m - eye_m_.z();
  if (height <= 0.0) return;  // below the eye's horizon
  const Eigen::Vector2d to_axis(thing.x_m - eye_m_.x(), thing.y_m - eye_m_.y());
  const double distance = to_axis.norm();
  const double nearest = distance - thing.radius_m;
  constexpr double kRounding = 1e-6;
  if (nearest <= 0.0) {  // overhead
    sine_.fill(1.0F + static_cast<float>(kRounding));
    return;
  }
  const auto bound = static_cast<float>(height / std::hypot(height, nearest) + kRounding);
  const double half = std::asin(thing.radius_m / distance);
  const double angle = std::atan2(to_axis.y(), to_axis.x());
  const std::size_t last = CellAt(angle + half);
  for (std::size_t cell = CellAt(angle - half);; cell = (cell + 1) % kCells) {
    sine_[cell] = std::max(sine_[cell], bound);
    if (cell == last) return;
  }
}

bool Skyline::IsBelow(const Eigen::Vector3d& ray) const {
  return ray.z() > sine_[CellAt(std::atan2(ray.y(), ray.x()))];
}

}  // namespace polnav::sim
