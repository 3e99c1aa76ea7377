// What do trees look like, and how do they close over a road?
#pragma once

#include <array>

#include "sim/random.h"
#include "sim/world/scene_builder.h"
#include "sim/world/street_frame.h"

namespace polnav::sim {

// Of what a crown's surface lies in the way of, it hides so much; two surfaces one behind the other
// hide the rest of the rest.
inline constexpr double kFoliageCover = 0.7;

struct TreeTextures {
  int bark = 0;
  std::array<int, 2> foliage{};
};
[[nodiscard]] TreeTextures AddTreeTextures(const RandomStream& stream, SceneBuilder& scene);

// Trunk, boughs and a crown of several lumps, all within crown_m of the trunk's axis.
void AddTree(const Eigen::Vector3d& foot_m, double height_m, double crown_m,
             const TreeTextures& textures, RandomStream::Sample& random, SceneBuilder& scene);

// Two rows of trees whose boughs reach over the road above the clear height.
struct Canopy {
  double start_m;
  double length_m;
  double clear_m;
  double density;
};
void AddCanopy(const Canopy& canopy, const StreetFrame& street, const RandomStream& stream,
               SceneBuilder& scene);

}  // namespace polnav::sim
