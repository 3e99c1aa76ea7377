// A small loop with uneven ground that tests of the world share.
#pragma once

#include "sim/world/street_frame.h"
#include "sim/world/terrain.h"
#include "sim/world/track.h"

namespace polnav::sim {

struct SmallLoop {
  Track track{TrackOptions{}};
  Terrain terrain{TerrainOptions{.slope_deg = 2.0, .camber_deg = 1.5}, track, 1};
  StreetFrame street{track, terrain};
};

}  // namespace polnav::sim
