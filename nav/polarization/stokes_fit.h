// At which angle does the sun stand, when every block counts for what it is worth?
//
// The sun's place is s_L(a) = (cos h cos a, cos h sin a, sin h) at elevation h: a is its angle from
// the level x axis towards y, and the heading is the sun's compass azimuth plus a. Rayleigh's field
// of it turns by one angle only, so each block gives one residual, the part of its (Q/I, U/I)
// across the direction that Rayleigh predicts, and one judge of itself: the part along it, over
// what a clear sky would have there. What Rayleigh leaves out is solved for along with the angle:
//   many scatterings  light polarized vertically, by the square of the elevation's cosine, which
//                     splits the neutral points off the sun [Chandrasekhar1960]: one amplitude
//   other light       (cloud, haze, obstacle) in place of light that is missing; its polarization
//                     may point anywhere but is alike within a patch of sky: one number a patch,
//                     times the share lost. A patch's clearest blocks count for most, and what its
//                     others show of that light is taken out of them.
//   the rest          variance = pixel noise + clear_sigma^2 + (lost_light_dop * share lost)^2
// A clear sky's greatest polarization is read off the picture (an upper quantile). Iteratively
// reweighted Gauss-Newton with Cauchy's loss, from the best angles of a coarse search.
// Its sigma: angle_sigma.h.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "nav/polarization/compass_options.h"
#include "nav/polarization/instrument_errors.h"
#include "nav/polarization/sky_blocks.h"

namespace polnav::nav {

struct StokesFit {
  double angle_rad = 0.0;  // a
  double sigma_rad = 0.0;
  double agreement = 0.0;      // mean cosine of twice the angle to the model, by polarization
  double max_dop = 0.0;        // a clear sky's, 90 degrees from the sun
  double dop = 0.0;            // mean by weight
  double used_fraction = 0.0;  // of the blocks in view
  double cost = 0.0;           // robust negative log-likelihood, summed over blocks
  // Between this angle and the next best: how far apart, and the log-likelihood between them.
  double rival_rad = 0.0;
  double evidence = 0.0;
  std::vector<float> weight;  // a block of `sky`, 0 to 1
};

// sky: not empty. sun_elevation_rad: neither horizon nor zenith need be avoided; sigma tells.
[[nodiscard]] StokesFit FitStokes(const CompassOptions& options, const SkyBlocks& sky,
                                  const Tiles& tiles, double sun_elevation_rad,
                                  const InstrumentErrors& instrument);

}  // namespace polnav::nav
