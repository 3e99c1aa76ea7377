#include "nav/polarization/mirror_patches.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "nav/api/geometry.h"

namespace polnav::nav {

MirrorPatches::MirrorPatches(double size_rad) {
  const int rings = std::max(1, static_cast<int>(std::lround(std::numbers::pi / 2.0 / size_rad)));
  height_rad_ = std::numbers::pi / 2.0 / rings;
  for (int k = 0; k < rings; ++k) {
    const double half_ring = std::numbers::pi * std::cos((k + 0.5) * height_rad_);
    const int patches = std::max(1, static_cast<int>(std::lround(half_ring / size_rad)));
    rings_.push_back({count_, patches});
    count_ += static_cast<std::size_t>(patches);
  }
}

MirrorPatch MirrorPatches::Of(const Eigen::Vector3d& ray, double sun_angle_rad) const {
  const double up = std::atan2(std::max(ray.z(), 0.0), std::hypot(ray.x(), ray.y()));
  const auto ring = std::min(static_cast<std::size_t>(up / height_rad_), rings_.size() - 1);
  const double from_sun = WrapPi(std::atan2(ray.y(), ray.x()) - sun_angle_rad);
  const int patches = rings_[ring].patches;
  const int along = static_cast<int>(std::abs(from_sun) / std::numbers::pi * patches);
  return {.index = rings_[ring].first + static_cast<std::size_t>(std::min(along, patches - 1)),
          .side = from_sun < 0.0 ? -1.0 : 1.0};
}

}  // namespace polnav::nav
