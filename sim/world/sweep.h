// How does a cross section become a surface along the road?
//
// The section runs from the right to the left of the road for what is seen from above; whatever its
// direction, the side is drawn that along x across points to (along: driving; across: the section).
// Corners are smooth: a sharp edge is two sweeps.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "sim/world/scene_builder.h"
#include "sim/world/street_frame.h"

namespace polnav::sim {

// A point of a cross section; offset as in StreetFrame, lift above the ground there.
struct Rib {
  double offset_m;
  double lift_m;
};

struct Sweep {
  double s0_m;
  double s1_m;
  int rows;
  std::vector<Rib> ribs;
  int texture;
};

using UvOf = std::function<Eigen::Vector2d(double along_01, int rib, const Eigen::Vector3d& p_m)>;
using ShadeOf = std::function<double(double s_m, const Rib& rib, const Eigen::Vector3d& p_m)>;

void AddSweep(const StreetFrame& street, const Sweep& sweep, const UvOf& uv_of,
              const ShadeOf& shade_of, SceneBuilder& scene);

}  // namespace polnav::sim
