#include "sim/sensors/inertial_triad.h"

#include <algorithm>
#include <cmath>

#include "sim/sensors/rotation.h"

namespace polnav::sim {

InertialTriad::InertialTriad(const TriadErrors& errors, double step_s, RandomStream::Sample flicker)
    : errors_(errors), step_s_(step_s), flicker_(errors.flicker_floor, step_s, flicker) {}

void InertialTriad::Step(RandomStream::Sample& walk, RandomStream::Sample& flicker) {
  walk_ += errors_.walk_sqrt_s * std::sqrt(step_s_) * GaussianVector(walk);
  flicker_.Step(flicker);
}

Eigen::Vector3d InertialTriad::Bias(double warmer_k) const {
  return errors_.bias + warmer_k * errors_.bias_1_k + walk_ + flicker_.value();
}

Eigen::Vector3d InertialTriad::Read(const Eigen::Vector3d& truth, double dt_s, double warmer_k,
                                    const Eigen::Vector3d& extra,
                                    RandomStream::Sample& noise) const {
  const Eigen::Vector3d bias =
      Bias(warmer_k) + extra + warmer_k * errors_.scale_1_k.cwiseProduct(truth);
  Eigen::Vector3d reading = errors_.distortion * truth + bias +
                            errors_.noise_sqrt_hz / std::sqrt(dt_s) * GaussianVector(noise);
  for (double& axis : reading) {
    axis = std::clamp(axis, -errors_.range, errors_.range);
    if (errors_.resolution > 0.0) {
      axis = errors_.resolution * std::round(axis / errors_.resolution);
    }
  }
  return reading;
}

}  // namespace polnav::sim
