// How bright is a white wall under this sky, and how bright is the sky itself?
//
// Radiance relative to the clear zenith, as in sky/skylight.h. A facet gets the sun by Lambert's
// law, the sky as the integral over the half space before it, and light from the ground. Nothing
// casts a shadow, and the sky is the one at the scenario's start: clouds in the pictures stand
// still, which no estimator here looks at.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sky/skylight.h"

namespace polnav::sim {

class Lighting {
 public:
  explicit Lighting(const sky::WorldSky& sky);

  // Radiance of a white Lambertian facet.
  [[nodiscard]] double OfWhite(const Eigen::Vector3d& normal_W) const;

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

// A polar net about the sun: rings close together where the aureole is steep.
struct SkyDome {
  struct Vertex {
    Eigen::Vector3f direction_W;
    float radiance;
  };
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
};
[[nodiscard]] SkyDome BuildSkyDome(const sky::WorldSky& sky);

}  // namespace polnav::sim
