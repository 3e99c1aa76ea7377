// What do the gyroscopes and accelerometers say?
//
//   I   the IMU's own axes: at B's origin, along B's up to the misalignment drawn once a trial
// Readings are exact means over the interval between two truths, so that noise-free ones integrate
// back to the truth: rate = log(q_begin^-1 q_end) / dt, and specific force = velocity change minus
// gravity, seen from the attitude half way. Then scale factor and misalignment, bias, white noise,
// resolution and range. Not in it: temperature, vibration rectification, g-sensitivity, lever arms.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "nav/api/calibration.h"
#include "nav/api/measurements.h"
#include "sim/random.h"
#include "sim/truth.h"

namespace polnav::sim {

// In W, at every site: standard gravity.
inline constexpr double kGravity_m_s2 = 9.80665;

// Defaults: an industrial-grade MEMS, Analog Devices ADIS16475-2 (data sheet Rev. D): angle random
// walk 0.15 deg/sqrt(h), accelerometers within 8 g, axes within 0.1 degrees. Our choices: turn-on
// biases as they are left by mounting stress and temperature; bias walks that in a minute reach
// three times the in-run stability (2.5 deg/h, 3.6 ug), because a car warms in the sun.
// YAML keys = field names.
struct ImuOptions {
  double rate_hz = 100.0;
  double gyro_noise_deg_s_sqrt_hz = 0.0025;
  double gyro_bias_sigma_deg_s = 0.1;           // turn-on to turn-on
  double gyro_bias_walk_deg_s_sqrt_s = 2.5e-4;  // grows by this times the root of the seconds
  double gyro_scale_sigma = 0.002;              // relative
  double gyro_range_deg_s = 500.0;              // readings stop here
  double gyro_resolution_deg_s = 0.00625;       // step of the 16-bit output; 0: none
  double accel_noise_mg_sqrt_hz = 0.025;
  double accel_bias_sigma_mg = 1.5;
  double accel_bias_walk_mg_sqrt_s = 0.0015;
  double accel_scale_sigma = 0.001;
  double accel_range_g = 8.0;
  double accel_resolution_mg = 0.25;
  double misalignment_sigma_deg = 0.1;  // of each axis of each triad towards the two others

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("rate_hz", rate_hz, {.min = 1.0, .max = 2000.0});
    v("gyro_noise_deg_s_sqrt_hz", gyro_noise_deg_s_sqrt_hz, {.min = 0.0, .max = 1.0});
    v("gyro_bias_sigma_deg_s", gyro_bias_sigma_deg_s, {.min = 0.0, .max = 10.0});
    v("gyro_bias_walk_deg_s_sqrt_s", gyro_bias_walk_deg_s_sqrt_s, {.min = 0.0, .max = 1.0});
    v("gyro_scale_sigma", gyro_scale_sigma, {.min = 0.0, .max = 0.1});
    v("gyro_range_deg_s", gyro_range_deg_s, {.min = 1.0, .max = 1e5});
    v("gyro_resolution_deg_s", gyro_resolution_deg_s, {.min = 0.0, .max = 10.0});
    v("accel_noise_mg_sqrt_hz", accel_noise_mg_sqrt_hz, {.min = 0.0, .max = 100.0});
    v("accel_bias_sigma_mg", accel_bias_sigma_mg, {.min = 0.0, .max = 200.0});
    v("accel_bias_walk_mg_sqrt_s", accel_bias_walk_mg_sqrt_s, {.min = 0.0, .max = 10.0});
    v("accel_scale_sigma", accel_scale_sigma, {.min = 0.0, .max = 0.1});
    v("accel_range_g", accel_range_g, {.min = 1.0, .max = 1e4});
    v("accel_resolution_mg", accel_resolution_mg, {.min = 0.0, .max = 100.0});
    v("misalignment_sigma_deg", misalignment_sigma_deg, {.min = 0.0, .max = 10.0});
  }
};

// What an estimator is told: aligned with B, and the white noise; nothing of this unit's biases.
[[nodiscard]] nav::ImuCalibration NominalImu(const ImuOptions& options);

class Imu {
 public:
  Imu(const ImuOptions& options, std::uint64_t seed, std::uint64_t trial);

  // Of the interval from begin to end, stamped at its end. index counts from 0 and must grow from
  // call to call; a skipped sample still moves the bias, so that sample k is the same whichever
  // others were taken.
  [[nodiscard]] nav::ImuSample Sample(const Truth& begin, const Truth& end, std::uint64_t index);

 private:
  // One triad's errors, SI.
  struct Triad {
    Eigen::Matrix3d distortion = Eigen::Matrix3d::Identity();  // scale factors and misalignment
    Eigen::Vector3d bias = Eigen::Vector3d::Zero();            // now, walk included
    double noise_sqrt_hz = 0.0;
    double walk_sqrt_s = 0.0;
    double range = 0.0;
    double resolution = 0.0;

    void Walk(double dt_s, RandomStream::Sample& draw);
    [[nodiscard]] Eigen::Vector3d Read(const Eigen::Vector3d& truth, double dt_s,
                                       RandomStream::Sample& draw) const;
  };

  ImuOptions options_;
  RandomStream noise_;
  RandomStream walk_;
  Triad gyro_;
  Triad accel_;
  std::uint64_t next_index_ = 0;
};

}  // namespace polnav::sim
