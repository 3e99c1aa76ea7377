// Where is the clear sky unpolarized?
//
// In the sun's vertical plane: Babinet above the sun, Brewster below it, Arago above the antisun
// and the fourth below that. rayleigh has its two in the sun and the antisun. Those of rayleigh and
// berry are known in closed form and given wherever they are; those of hazy are found as sign
// changes of Q along the plane and given above the horizon.
// Where it fails: hazy's points off the plane, which the sea's glint can make, are not looked for.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sky/clear_sky.h"

namespace polnav::sky {

struct NeutralPoint {
  std::string name;
  Eigen::Vector3d ray_W;  // unit vector, ENU
};

[[nodiscard]] std::vector<NeutralPoint> NeutralPoints(const ClearSky& sky);

}  // namespace polnav::sky
