// How wrong may one reading of the sky be?
//
// White noise grows as the degree of polarization falls; what is less polarized than a clear sky
// has light from elsewhere in it, which fakes in proportion to its share.
#pragma once

#include <Eigen/Core>

#include "nav/polarization/options.h"
#include "nav/polarization/six_channel.h"

namespace polnav::nav {

// What does not average out over some seconds, the instrument's own errors included [rad].
[[nodiscard]] double SlowSigma(const PolarizationOptions& options);

struct ReadingErrors {
  double white_rad = 0.0;      // one sigma
  double foreign_share = 0.0;  // of light that a clear sky would not send, over the sky's own
};

// look_W: where the instrument looks; sun_W: towards the sun; both unit.
[[nodiscard]] ReadingErrors ErrorsOf(const PolarizedLight& light, const Eigen::Vector3d& look_W,
                                     const Eigen::Vector3d& sun_W,
                                     const PolarizationOptions& options);

}  // namespace polnav::nav
