// What does the filter know before the first measurement?
#pragma once

#include "nav/api/calibration.h"
#include "nav/api/estimate.h"
#include "nav/ukf/options.h"
#include "nav/ukf/state.h"

namespace polnav::nav::ukf {

// Throws std::invalid_argument, which names it, for a sigma that is negative or no number.
void CheckSigmas(const ImuCalibration& imu, const OpticalFlowCalibration& flow,
                 const StartPrior& start);

// What scale errors and gravity fake as a bias of a robot that walks level, one sigma an axis.
[[nodiscard]] Eigen::Vector3d FakedGyroBias(const UkfOptions& options);
[[nodiscard]] Eigen::Vector3d FakedAccelBias(const UkfOptions& options);

[[nodiscard]] State StartState(const UkfOptions& options, const ImuCalibration& imu,
                               const OpticalFlowCalibration& flow, const StartPrior& start,
                               TimeNs stamp);

// In the coordinates of the interface, of B.
[[nodiscard]] Estimate EstimateOf(const State& state, const UkfOptions& options, const Pose& T_BI);

}  // namespace polnav::nav::ukf
