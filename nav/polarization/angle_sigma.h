// How far off may the angle of a fit be?
//
// Five parts, each by what it can do to the angle:
//   pixels' noise
//   pattern     what a clear sky has beside Rayleigh's: alike over a patch and its mirror image
//               (mirror_patches.h), as large as this picture's residuals are
//   gaps        what clouds add to the clear sky between them, times the light that is missing
//   residuals   what patches under clouds still pull by, since where no sky is clear cloud is taken
//               for it
//   instrument  each error by its own effect; tilt is one of them
#pragma once

#include "nav/polarization/angle_fit.h"
#include "nav/polarization/instrument_errors.h"

namespace polnav::nav {

// Of the angle. [rad^2]
struct AngleVariance {
  double sky = 0.0;
  double instrument = 0.0;
};

// At the angle of the fit's last judgement, with blocks judged as they are. Infinite where the
// angle does nothing.
[[nodiscard]] AngleVariance VarianceOf(const CompassOptions& options, const SkyBlocks& sky,
                                       const Tiles& tiles, const AngleFit& fit, double angle_rad,
                                       const InstrumentErrors& instrument);

}  // namespace polnav::nav
