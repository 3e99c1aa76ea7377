// What do three like sensors at right angles make of the truth? One triad of an IMU, SI units.
//
//   reading = round(clamp((M + dT S) truth + b + dT b_T + flicker + walk + extra + white noise))
// M: scale factors on the diagonal, misalignment beside it; dT: kelvins above calibration. Order:
// the noise is the sensing element's, range and resolution are its converter's.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "sim/random.h"
#include "sim/sensors/flicker_noise.h"

namespace polnav::sim {

// One unit's errors, drawn or chosen.
struct TriadErrors {
  Eigen::Matrix3d distortion = Eigen::Matrix3d::Identity();
  Eigen::Vector3d scale_1_k = Eigen::Vector3d::Zero();
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();  // at turn-on, at calibration temperature
  Eigen::Vector3d bias_1_k = Eigen::Vector3d::Zero();
  double noise_sqrt_hz = 0.0;
  double flicker_floor = 0.0;  // of the Allan deviation
  double walk_sqrt_s = 0.0;
  double range = 0.0;
  double resolution = 0.0;  // 0: none
};

class InertialTriad {
 public:
  // step_s between samples; flicker's generator is for where it stands at the start.
  InertialTriad(const TriadErrors& errors, double step_s, RandomStream::Sample flicker);

  // The bias moves on by one sample.
  void Step(RandomStream::Sample& walk, RandomStream::Sample& flicker);

  [[nodiscard]] Eigen::Vector3d Bias(double warmer_k) const;

  // Mean of the truth over dt_s; extra: errors that other sensors' truth causes.
  [[nodiscard]] Eigen::Vector3d Read(const Eigen::Vector3d& truth, double dt_s, double warmer_k,
                                     const Eigen::Vector3d& extra,
                                     RandomStream::Sample& noise) const;

 private:
  TriadErrors errors_;
  double step_s_;
  FlickerNoise flicker_;
  Eigen::Vector3d walk_ = Eigen::Vector3d::Zero();
};

}  // namespace polnav::sim
