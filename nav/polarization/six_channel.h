// What does a six-channel reading say about the light?
//
// [Zeng2020, eqs 4-8]: three opponent pairs give p_k = d cos(2 phi - 2 alpha_k), free of the total
// intensity, alpha = 0, 60, 120 degrees. phi is an axis: it repeats every half turn.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "nav/api/calibration.h"
#include "nav/api/measurements.h"
#include "nav/polarization/options.h"

namespace polnav::nav {

struct PolarizedLight {
  double dop = 0.0;       // degree of linear polarization [-]
  double axis_rad = 0.0;  // of the E-vector, from S's x towards its y, in (-pi/2, pi/2]
  double pair_sum = 0.0;  // p1 + p2 + p3: zero for a healthy sensor
};

// Nothing when a pair sees no light.
[[nodiscard]] std::optional<PolarizedLight> DecodeSixChannels(const PolarizationSample& sample);

// Nothing when the light is too little polarized or the channels contradict each other.
[[nodiscard]] std::optional<PolarizedLight> UsableLight(const PolarizationSample& sample,
                                                        const PolarizationOptions& options);

// The light's E-vector in B, a unit vector whose sign means nothing.
[[nodiscard]] Eigen::Vector3d EVectorOf(const PolarizedLight& light,
                                        const PolarimeterCalibration& calibration);

}  // namespace polnav::nav
