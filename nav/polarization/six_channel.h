// What does a six-channel reading say about the light?
//
// [Zeng2020, eqs 4-8]: three opponent pairs give p_k = d cos(2 phi - 2 alpha_k), free of the total
// intensity, alpha = 0, 60, 120 degrees. phi is an axis: it repeats every half turn.
#pragma once

#include <array>
#include <optional>

#include "nav/api/measurements.h"

namespace polnav::nav {

struct PolarizedLight {
  double dop = 0.0;       // degree of linear polarization [-]
  double axis_rad = 0.0;  // of the E-vector, from S's x towards its y, in (-pi/2, pi/2]
  double pair_sum = 0.0;  // p1 + p2 + p3: zero for a healthy sensor
};

// Nothing when a pair sees no light.
[[nodiscard]] std::optional<PolarizedLight> DecodeSixChannels(const PolarizationSample& sample);

}  // namespace polnav::nav
