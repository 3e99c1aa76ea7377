// Where is the solar meridian, when nobody says how high the sun stands?
//
// All E-vectors are across the sun: the least of sum |p|^2 (e . s)^2 over unit s is near the sun or
// the antisun. Elevations about it are then searched with the heading's own fit (stokes_fit.h).
#pragma once

#include <optional>

#include "nav/polarization/compass_options.h"
#include "nav/polarization/sky_blocks.h"
#include "nav/polarization/stokes_fit.h"

namespace polnav::nav {

// angle_rad and sigma_rad of the result are the meridian's, mod pi; elevation_rad is the sun's or,
// with its sign changed, the antisun's. Nothing when the blocks are too few.
struct MeridianFit {
  StokesFit fit;
  double elevation_rad = 0.0;
};

[[nodiscard]] std::optional<MeridianFit> FitMeridian(const CompassOptions& options,
                                                     const SkyBlocks& sky, const Tiles& tiles,
                                                     const InstrumentErrors& instrument);

}  // namespace polnav::nav
