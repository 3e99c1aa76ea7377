#include "sim/sensors/imu.h"

#include <cmath>
#include <stdexcept>

#include "sim/sensors/rotation.h"

namespace polnav::sim {

namespace {

constexpr double kMilliG_m_s2 = 1e-3 * kGravity_m_s2;
constexpr double kCalibrated_deg_c = 25.0;

// Small errors of scale on the diagonal, of the axes' directions beside it.
Eigen::Matrix3d DrawDistortion(double scale_sigma, double misalignment_sigma_rad,
                               RandomStream::Sample& draw) {
  Eigen::Matrix3d distortion = Eigen::Matrix3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const double sigma = row == column ? scale_sigma : misalignment_sigma_rad;
      distortion(row, column) += sigma * draw.Gaussian();
    }
  }
  return distortion;
}

// Above the temperature of calibration.
double WarmerAt(const ImuTemperatureOptions& options, double t_s) {
  const double left = std::exp(-t_s / options.time_constant_s);
  return options.end_deg_c + left * (options.start_deg_c - options.end_deg_c) - kCalibrated_deg_c;
}

Eigen::Vector3d VelocityAt(const Eigen::Vector3d& r_B, const Truth& truth) {
  return truth.v_WB_m_s + truth.T_WB.q * truth.w_WB_B_rad_s.cross(r_B);
}

// Exact means of rate and specific force at a point r_B fixed in B, in B's axes.
struct MeanMotion {
  Eigen::Vector3d rate_rad_s;
  Eigen::Vector3d force_m_s2;
};

MeanMotion MeanMotionAt(const Eigen::Vector3d& r_B, const Truth& begin, const Truth& end) {
  const double dt_s = nav::ToSeconds(end.stamp - begin.stamp);
  const Eigen::Vector3d turn = RotationVector(begin.T_WB.q.conjugate() * end.T_WB.q);
  const Eigen::Quaterniond q_WB_mid = begin.T_WB.q * RotationOf(0.5 * turn);
  const Eigen::Vector3d gravity_W(0.0, 0.0, -kGravity_m_s2);
  const Eigen::Vector3d force_W =
      (VelocityAt(r_B, end) - VelocityAt(r_B, begin)) / dt_s - gravity_W;
  return {turn / dt_s, q_WB_mid.conjugate() * force_W};
}

}  // namespace

nav::ImuCalibration NominalImu(const ImuOptions& options) {
  return {
      .T_BI = {.p = options.position_m},
      .rate_hz = options.rate_hz,
      .gyro_noise_rad_s_sqrt_hz = nav::DegToRad(options.gyro_noise_deg_s_sqrt_hz),
      .accel_noise_m_s2_sqrt_hz = options.accel_noise_mg_sqrt_hz * kMilliG_m_s2,
      .gyro_bias_sigma_rad_s = nav::DegToRad(options.gyro_bias_sigma_deg_s),
      .accel_bias_sigma_m_s2 = options.accel_bias_sigma_mg * kMilliG_m_s2,
      .gyro_bias_instability_rad_s = nav::DegToRad(options.gyro_bias_instability_deg_h) / 3600.0,
      .accel_bias_instability_m_s2 = options.accel_bias_instability_mg * kMilliG_m_s2,
      .gyro_bias_walk_rad_s_sqrt_s = nav::DegToRad(options.gyro_bias_walk_deg_s_sqrt_s),
      .accel_bias_walk_m_s2_sqrt_s = options.accel_bias_walk_mg_sqrt_s * kMilliG_m_s2};
}

// Each kind of error has draws of its own, so that a new one leaves a unit's others as they are.
Imu::Instrument Imu::DrawInstrument(const ImuOptions& options, std::uint64_t seed,
                                    std::uint64_t trial) {
  RandomStream::Sample draw = RandomStream(seed, trial, "imu/instrument").At(0);
  RandomStream::Sample warm = RandomStream(seed, trial, "imu/temperature").At(0);
  const double misalignment_rad = nav::DegToRad(options.misalignment_sigma_deg);
  RandomStream::Sample force = RandomStream(seed, trial, "imu/g_sensitivity").At(0);
  Instrument unit;
  unit.gyro.distortion = DrawDistortion(options.gyro_scale_sigma, misalignment_rad, draw);
  unit.gyro.bias = nav::DegToRad(options.gyro_bias_sigma_deg_s) * GaussianVector(draw) +
                   nav::DegToRad(1.0) * options.gyro_bias_deg_s;
  unit.gyro.bias_1_k = nav::DegToRad(options.gyro_temperature_bias_deg_s_k) * GaussianVector(warm);
  unit.gyro.scale_1_k = options.gyro_temperature_scale_1_k * GaussianVector(warm);
  unit.gyro.noise_sqrt_hz = nav::DegToRad(options.gyro_noise_deg_s_sqrt_hz);
  unit.gyro.flicker_floor = nav::DegToRad(options.gyro_bias_instability_deg_h) / 3600.0;
  unit.gyro.walk_sqrt_s = nav::DegToRad(options.gyro_bias_walk_deg_s_sqrt_s);
  unit.gyro.range = nav::DegToRad(options.gyro_range_deg_s);
  unit.gyro.resolution = nav::DegToRad(options.gyro_resolution_deg_s);
  unit.accel.distortion = DrawDistortion(options.accel_scale_sigma, misalignment_rad, draw);
  unit.accel.bias = options.accel_bias_sigma_mg * kMilliG_m_s2 * GaussianVector(draw) +
                    kMilliG_m_s2 * options.accel_bias_mg;
  unit.accel.bias_1_k = options.accel_temperature_bias_mg_k * kMilliG_m_s2 * GaussianVector(warm);
  unit.accel.scale_1_k = options.accel_temperature_scale_1_k * GaussianVector(warm);
  unit.accel.noise_sqrt_hz = options.accel_noise_mg_sqrt_hz * kMilliG_m_s2;
  unit.accel.flicker_floor = options.accel_bias_instability_mg * kMilliG_m_s2;
  unit.accel.walk_sqrt_s = options.accel_bias_walk_mg_sqrt_s * kMilliG_m_s2;
  unit.accel.range = options.accel_range_g * kGravity_m_s2;
  unit.accel.resolution = options.accel_resolution_mg * kMilliG_m_s2;
  const double rate_by_force_sigma =
      nav::DegToRad(options.gyro_g_sensitivity_deg_s_g) / kGravity_m_s2;
  for (double& element : unit.rate_by_force_s_m.reshaped()) {
    element = rate_by_force_sigma * force.Gaussian();
  }
  return unit;
}

Imu::Imu(const ImuOptions& options, std::uint64_t seed, std::uint64_t trial)
    : Imu(options, DrawInstrument(options, seed, trial), seed, trial) {}

Imu::Imu(const ImuOptions& options, const Instrument& unit, std::uint64_t seed, std::uint64_t trial)
    : options_(options),
      noise_(seed, trial, "imu"),
      walk_(seed, trial, "imu/bias"),
      gyro_flicker_(seed, trial, "imu/gyro_flicker"),
      accel_flicker_(seed, trial, "imu/accel_flicker"),
      rate_by_force_s_m_(unit.rate_by_force_s_m),
      gyro_(unit.gyro, 1.0 / options.rate_hz, gyro_flicker_.At(0)),
      accel_(unit.accel, 1.0 / options.rate_hz, accel_flicker_.At(0)) {}

nav::ImuSample Imu::Sample(const Truth& begin, const Truth& end, std::uint64_t index) {
  if (end.stamp <= begin.stamp) {
    throw std::logic_error("Imu::Sample: the interval is empty");
  }
  if (index < next_index_) {
    throw std::logic_error("Imu::Sample: samples must be taken in order");
  }
  for (; next_index_ <= index; ++next_index_) {
    RandomStream::Sample walk = walk_.At(next_index_);
    RandomStream::Sample gyro_flicker = gyro_flicker_.At(next_index_ + 1);
    RandomStream::Sample accel_flicker = accel_flicker_.At(next_index_ + 1);
    gyro_.Step(walk, gyro_flicker);
    accel_.Step(walk, accel_flicker);
  }

  const MeanMotion motion = MeanMotionAt(options_.position_m, begin, end);
  const double dt_s = nav::ToSeconds(end.stamp - begin.stamp);
  const double warmer_k = WarmerAt(options_.temperature, nav::ToSeconds(end.stamp));
  RandomStream::Sample noise = noise_.At(index);
  nav::ImuSample sample;
  sample.stamp = end.stamp;
  sample.gyro_rad_s =
      gyro_.Read(motion.rate_rad_s, dt_s, warmer_k, rate_by_force_s_m_ * motion.force_m_s2, noise);
  sample.accel_m_s2 =
      accel_.Read(motion.force_m_s2, dt_s, warmer_k, Eigen::Vector3d::Zero(), noise);
  return sample;
}

ImuBias Imu::Bias(nav::TimeNs stamp) const {
  const double warmer_k = WarmerAt(options_.temperature, nav::ToSeconds(stamp));
  return {.gyro_rad_s = gyro_.Bias(warmer_k), .accel_m_s2 = accel_.Bias(warmer_k)};
}

}  // namespace polnav::sim
