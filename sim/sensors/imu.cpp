#include "sim/sensors/imu.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/sensors/rotation.h"

namespace polnav::sim {

namespace {

constexpr double kMilliG_m_s2 = 1e-3 * kGravity_m_s2;

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

}  // namespace

nav::ImuCalibration NominalImu(const ImuOptions& options) {
  return {.rate_hz = options.rate_hz,
          .gyro_noise_rad_s_sqrt_hz = nav::DegToRad(options.gyro_noise_deg_s_sqrt_hz),
          .accel_noise_m_s2_sqrt_hz = options.accel_noise_mg_sqrt_hz * kMilliG_m_s2};
}

void Imu::Triad::Walk(double dt_s, RandomStream::Sample& draw) {
  bias += walk_sqrt_s * std::sqrt(dt_s) * GaussianVector(draw);
}

Eigen::Vector3d Imu::Triad::Read(const Eigen::Vector3d& truth, double dt_s,
                                 RandomStream::Sample& draw) const {
  Eigen::Vector3d reading =
      distortion * truth + bias + noise_sqrt_hz / std::sqrt(dt_s) * GaussianVector(draw);
  for (double& axis : reading) {
    axis = std::clamp(axis, -range, range);
    if (resolution > 0.0) {
      axis = resolution * std::round(axis / resolution);
    }
  }
  return reading;
}

Imu::Imu(const ImuOptions& options, std::uint64_t seed, std::uint64_t trial)
    : options_(options), noise_(seed, trial, "imu"), walk_(seed, trial, "imu/bias") {
  RandomStream::Sample draw = RandomStream(seed, trial, "imu/instrument").At(0);
  const double misalignment_rad = nav::DegToRad(options.misalignment_sigma_deg);
  gyro_.distortion = DrawDistortion(options.gyro_scale_sigma, misalignment_rad, draw);
  gyro_.bias = nav::DegToRad(options.gyro_bias_sigma_deg_s) * GaussianVector(draw);
  gyro_.noise_sqrt_hz = nav::DegToRad(options.gyro_noise_deg_s_sqrt_hz);
  gyro_.walk_sqrt_s = nav::DegToRad(options.gyro_bias_walk_deg_s_sqrt_s);
  gyro_.range = nav::DegToRad(options.gyro_range_deg_s);
  gyro_.resolution = nav::DegToRad(options.gyro_resolution_deg_s);
  accel_.distortion = DrawDistortion(options.accel_scale_sigma, misalignment_rad, draw);
  accel_.bias = options.accel_bias_sigma_mg * kMilliG_m_s2 * GaussianVector(draw);
  accel_.noise_sqrt_hz = options.accel_noise_mg_sqrt_hz * kMilliG_m_s2;
  accel_.walk_sqrt_s = options.accel_bias_walk_mg_sqrt_s * kMilliG_m_s2;
  accel_.range = options.accel_range_g * kGravity_m_s2;
  accel_.resolution = options.accel_resolution_mg * kMilliG_m_s2;
}

nav::ImuSample Imu::Sample(const Truth& begin, const Truth& end, std::uint64_t index) {
  if (end.stamp <= begin.stamp) {
    throw std::logic_error("Imu::Sample: the interval is empty");
  }
  if (index < next_index_) {
    throw std::logic_error("Imu::Sample: samples must be taken in order");
  }
  for (; next_index_ <= index; ++next_index_) {
    RandomStream::Sample step = walk_.At(next_index_);
    gyro_.Walk(1.0 / options_.rate_hz, step);
    accel_.Walk(1.0 / options_.rate_hz, step);
  }

  const double dt_s = nav::ToSeconds(end.stamp - begin.stamp);
  const Eigen::Vector3d turn = RotationVector(begin.T_WB.q.conjugate() * end.T_WB.q);
  const Eigen::Quaterniond q_WB_mid = begin.T_WB.q * RotationOf(0.5 * turn);
  const Eigen::Vector3d gravity_W(0.0, 0.0, -kGravity_m_s2);
  const Eigen::Vector3d force_W = (end.v_WB_m_s - begin.v_WB_m_s) / dt_s - gravity_W;

  RandomStream::Sample draw = noise_.At(index);
  nav::ImuSample sample;
  sample.stamp = end.stamp;
  sample.gyro_rad_s = gyro_.Read(turn / dt_s, dt_s, draw);
  sample.accel_m_s2 = accel_.Read(q_WB_mid.conjugate() * force_W, dt_s, draw);
  return sample;
}

}  // namespace polnav::sim
