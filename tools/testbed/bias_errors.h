// Did an estimator find the biases of its IMU?
//
// Estimates that carry biases, against those of the truth at the same instant; both in the IMU's
// axes. Degrees a second and thousandths of standard gravity, as data sheets have them. Of real
// recordings the truth's biases are somebody's estimates.
#pragma once

#include <optional>
#include <vector>

#include "nav/api/estimate.h"
#include "sim/truth.h"

namespace polnav::testbed {

// Of three gyroscopes, or accelerometers. Whether they lie within three sigma says little where the
// sigmas stayed as wide as they were at the start: those are given too.
struct TriadBiasScore {
  double last = 0.0;            // length of the error at the end of the run
  double last_sigma = 0.0;      // what the estimator then expects of that length: root of the trace
  double within_3_sigma = 0.0;  // share of the axes, at the end
  // Squared error over its covariance, 3 when honest: at the end, and the mean over the run. Absent
  // where no covariance is positive definite.
  std::optional<double> nees_last;
  std::optional<double> nees;
};

struct BiasScore {
  TriadBiasScore gyro_deg_s;
  TriadBiasScore accel_mg;
};

// Nothing without an estimate of biases at an instant whose true ones are known.
[[nodiscard]] std::optional<BiasScore> ScoreBiases(const std::vector<sim::Truth>& truth,
                                                   const std::vector<nav::Estimate>& estimates);

}  // namespace polnav::testbed
