// Which blocks of which pictures see skies that err alike?
//
// Patches of sky are counted by elevation and by their angle from the solar meridian, to whichever
// side. A clear sky is its own mirror image about the meridian: sun, air and ground know no side.
// So what it has beside Rayleigh's pattern is one number a patch, with the sign of the side; and in
// all pictures of a turn, too, since the sky stays while the camera turns. Where it fails: clouds,
// and haze or ground that are brighter to one side.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace polnav::nav {

struct MirrorPatch {
  std::size_t index = 0;  // below MirrorPatches::count()
  double side = 1.0;      // -1: clockwise of the sun
};

class MirrorPatches {
 public:
  // size_rad: of a patch, about.
  explicit MirrorPatches(double size_rad);

  [[nodiscard]] std::size_t count() const { return count_; }
  // ray: in a frame with z up, in which the sun stands at sun_angle_rad from x towards y. Rays
  // below the horizon count as on it.
  [[nodiscard]] MirrorPatch Of(const Eigen::Vector3d& ray, double sun_angle_rad) const;

 private:
  struct Ring {
    std::size_t first = 0;
    int patches = 1;  // of half the ring
  };
  double height_rad_ = 0.0;
  std::vector<Ring> rings_;  // from the horizon up
  std::size_t count_ = 0;
};

}  // namespace polnav::nav
