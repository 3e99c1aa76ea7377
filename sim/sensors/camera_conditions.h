// What stands between the scene and the camera's pixels at one instant, besides its own optics?
#pragma once

#include <limits>

namespace polnav::sim {

// The default is a clean lens in clear air.
struct CameraConditions {
  double light_share = 1.0;  // of the scene's light that there is: dusk, lamps going out
  double gain_share = 1.0;   // of the gain that would be right: above 1 over-exposed
  double visibility_m =
      std::numeric_limits<double>::infinity();  // fog: contrast falls to 2 % there
  double glare = 0.0;       // strength of the veil that light from beside the picture throws [-]
  double dirt_share = 0.0;  // of the lens under dirt that stays where it is
  double rain_share = 0.0;  // of the lens under drops, which change
};

}  // namespace polnav::sim
