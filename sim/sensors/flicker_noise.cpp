#include "sim/sensors/flicker_noise.h"

#include <cmath>
#include <numbers>

#include "sim/sensors/rotation.h"

namespace polnav::sim {

double FlickerNoise::Sigma() { return std::sqrt(std::numbers::ln10 / (2.0 * std::numbers::ln2)); }

FlickerNoise::FlickerNoise(double floor, double step_s, RandomStream::Sample draw)
    : sigma_(floor * Sigma()) {
  states_.fill(Eigen::Vector3d::Zero());
  if (sigma_ == 0.0) return;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    kept_[i] = std::exp(-step_s / kCorrelationTimes_s[i]);
    states_[i] = sigma_ * GaussianVector(draw);
    start_ += states_[i];
  }
}

void FlickerNoise::Step(RandomStream::Sample& draw) {
  if (sigma_ == 0.0) return;
  value_ = -start_;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const double fresh = sigma_ * std::sqrt(1.0 - kept_[i] * kept_[i]);
    states_[i] = kept_[i] * states_[i] + fresh * GaussianVector(draw);
    value_ += states_[i];
  }
}

}  // namespace polnav::sim
