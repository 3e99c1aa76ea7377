// What does a six-channel reading of the sky say about the attitude?
//
// Under a Rayleigh sky the E-vector is across ray and sun [Zeng2020, eqs 2-10]: seen in the
// instrument S, along z x s with s = R_SI R_WI^T s_W, at the angle phi = atan2(s_x, -s_y), an axis
// (mod pi). The whole attitude is in it: a body that tilts reads otherwise, and by how much tells
// of the tilt. For a level one it is the papers' formula, heading = phi + sun's azimuth +- pi/2.
// Errors: a white part that falls with the degree of polarization; slow ones, each a state (sky and
// instrument; light from elsewhere, in proportion to its share; a constant), see
// nav/polarization/options.h. The sky of the world is not Rayleigh's; under cloud it is off by
// degrees.
#pragma once

#include <optional>

#include "nav/polarization/six_channel.h"
#include "nav/ukf/correct.h"

namespace polnav::nav::ukf {

struct SkyReading {
  PolarizedLight light;
  Eigen::Vector3d sun_W = Eigen::Vector3d::UnitY();
  double white_rad = 0.0;    // one sigma
  double slow_rad = 0.0;     // of one sigma of the slow state
  double foreign_rad = 0.0;  // likewise
};

// How far the reading's errors go, with the share of light that a clear sky would not send.
[[nodiscard]] SkyReading WeighReading(const PolarizedLight& light, const Eigen::Vector3d& sun_W,
                                      const Eigen::Quaterniond& q_WS,
                                      const PolarizationOptions& options);

// Angle of the E-vector in S [rad], of the state moved by an error; in (-pi, pi].
[[nodiscard]] double AxisOf(const State& state, const Eigen::Quaterniond& q_IS,
                            const Eigen::Vector3d& sun_W, const Error& error);

// Of the reading's residual: the mean is what is expected of measured less nominal axis.
[[nodiscard]] Expected<1> ExpectSky(const State& state, const Eigen::Quaterniond& q_IS,
                                    const SkyReading& reading);

}  // namespace polnav::nav::ukf
