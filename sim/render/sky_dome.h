// What does the sky look like behind everything?
//
// A polar net about the sun, rings close together where the aureole is steep. The clouds on it are
// those that polarimeters see, as seen from above the origin.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sky/skylight.h"

namespace polnav::sim {

struct SkyDome {
  struct Vertex {
    Eigen::Vector3f direction_W;
    float radiance;
  };
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  // Parts of the indices, each within a cone.
  struct Patch {
    std::size_t first;
    std::size_t count;
    Eigen::Vector3d direction_W;
    double radius_rad;
  };
  std::vector<Patch> patches;
};

[[nodiscard]] SkyDome BuildSkyDome(const sky::WorldSky& sky);

// Its radiances at an instant.
void UpdateRadiance(const sky::WorldSky& sky, double t_s, SkyDome& dome);

}  // namespace polnav::sim
