// How bright is a white wall under this sky, in the sun and in the shade?
//
// Radiance relative to the clear zenith, as in sky/skylight.h. A facet gets the sun by Lambert's
// law, the sky as the integral over the half space before it, and light from the ground. Sun and
// skylight are those of the scenario's start; what clouds and things keep of the sun is the
// renderer's affair.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sky/skylight.h"

namespace polnav::sim {

class Lighting {
 public:
  explicit Lighting(const sky::WorldSky& sky);

  // Radiance of a white Lambertian facet, by origin of the light: from sky and ground; from the sun
  // where nothing is in its way.
  [[nodiscard]] double FromSky(const Eigen::Vector3d& normal_W) const;
  [[nodiscard]] double FromSun(const Eigen::Vector3d& normal_W) const;
  // Both.
  [[nodiscard]] double OfWhite(const Eigen::Vector3d& normal_W) const;

  // FromSky's best fit in 1, x, y, z, xy, yz, xz, x^2 - y^2, 3 z^2 - 1 of the normal, for what
  // turns; within 3 % of the brightest [Ramamoorthi2001].
  [[nodiscard]] std::array<float, 9> SkyHarmonics() const;

  [[nodiscard]] const Eigen::Vector3d& sun_W() const { return sun_W_; }
  [[nodiscard]] double sun() const { return sun_; }

 private:
  struct SkyPatch {
    Eigen::Vector3d direction_W;
    double weight;  // radiance times solid angle over pi
  };
  Eigen::Vector3d sun_W_;
  double sun_ = 0.0;     // direct light on a facet that faces the sun, over pi
  double ground_ = 0.0;  // radiance of the ground that walls face
  std::vector<SkyPatch> patches_;
};

}  // namespace polnav::sim
