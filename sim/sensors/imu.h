// What do the gyroscopes and accelerometers say?
//
//   I   the IMU's own axes: at position_m in B, along B's up to the misalignment drawn once a trial
// Readings are exact means over the interval between two truths, of the point where the IMU sits
// (so that a lever arm brings its centripetal and tangential acceleration with it):
//   rate = log(q_begin^-1 q_end) / dt
//   specific force = velocity change / dt minus gravity, seen from the attitude half way
// Noise-free ones integrate back to the truth, and docs/imu.md says by which schemes. Then come the
// errors of inertial_triad.h, and of the gyroscopes also what the specific force fakes.
// Not in it: the earth's rotation (W does not turn), vibration rectification, non-linear scale,
// hysteresis of the temperature.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "nav/api/calibration.h"
#include "nav/api/measurements.h"
#include "sim/random.h"
#include "sim/sensors/imu_options.h"
#include "sim/sensors/inertial_triad.h"
#include "sim/truth.h"

namespace polnav::sim {

// In W, at every site: standard gravity.
inline constexpr double kGravity_m_s2 = 9.80665;

// What an estimator is told: the data sheet and where the IMU sits; nothing of this unit's errors.
[[nodiscard]] nav::ImuCalibration NominalImu(const ImuOptions& options);

class Imu {
 public:
  Imu(const ImuOptions& options, std::uint64_t seed, std::uint64_t trial);

  // Of the interval from begin to end, stamped at its end. index counts from 0 and must grow from
  // call to call; a skipped sample still moves the bias, so that sample k is the same whichever
  // others were taken.
  [[nodiscard]] nav::ImuSample Sample(const Truth& begin, const Truth& end, std::uint64_t index);

  // Of the sample taken last (at first: from turn-on), as warm as at `stamp`.
  [[nodiscard]] ImuBias Bias(nav::TimeNs stamp) const;

 private:
  // One unit.
  struct Instrument {
    TriadErrors gyro;
    TriadErrors accel;
    Eigen::Matrix3d rate_by_force_s_m;  // gyroscopes' g-sensitivity [rad/s per m/s^2]
  };
  static Instrument DrawInstrument(const ImuOptions& options, std::uint64_t seed,
                                   std::uint64_t trial);
  Imu(const ImuOptions& options, const Instrument& unit, std::uint64_t seed, std::uint64_t trial);

  ImuOptions options_;
  RandomStream noise_;
  RandomStream walk_;
  RandomStream gyro_flicker_;  // 0: where it stands at the start
  RandomStream accel_flicker_;
  Eigen::Matrix3d rate_by_force_s_m_;
  InertialTriad gyro_;
  InertialTriad accel_;
  std::uint64_t next_index_ = 0;
};

}  // namespace polnav::sim
