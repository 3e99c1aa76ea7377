#include "nav/inertial/preintegration.h"

#include <algorithm>
#include <cmath>

#include "nav/stereo/reprojection.h"

namespace polnav::nav {
namespace {

// Bias instability wanders over minutes; as a random walk it is reached after this time.
constexpr double kInstabilityTime_s = 100.0;

double Walk(double walk, double instability) {
  return std::max({1e-8, walk, instability / std::sqrt(kInstabilityTime_s)});
}

// Better than any IMU, so that an ideal one leaves no singular matrix.
constexpr double kLeastGyro = 1e-6;
constexpr double kLeastAccel = 1e-5;

}  // namespace

ImuNoise NoiseOf(const ImuCalibration& c, const InertialOptions& options) {
  const double tilt = DegToRad(options.misalignment_sigma_deg);
  return {
      .gyro_rad_s_sqrt_hz = std::max(kLeastGyro, c.gyro_noise_rad_s_sqrt_hz),
      .accel_m_s2_sqrt_hz = std::max(kLeastAccel, c.accel_noise_m_s2_sqrt_hz),
      .share_of_rate = std::hypot(options.scale_sigma, tilt),
      .gyro_bias_rad_s = std::max(kLeastGyro, c.gyro_bias_sigma_rad_s),
      // Gravity on a crooked axis looks like a bias.
      .accel_bias_m_s2 =
          std::max(kLeastAccel, std::hypot(c.accel_bias_sigma_m_s2, tilt * kGravity_m_s2)),
      .gyro_walk_rad_s_sqrt_s = Walk(c.gyro_bias_walk_rad_s_sqrt_s, c.gyro_bias_instability_rad_s),
      .accel_walk_m_s2_sqrt_s = Walk(c.accel_bias_walk_m_s2_sqrt_s, c.accel_bias_instability_m_s2)};
}

Eigen::Matrix3d RightJacobian(const Eigen::Vector3d& theta) {
  const double angle2 = theta.squaredNorm();
  const Eigen::Matrix3d s = Skew(theta);
  if (angle2 < 1e-8) return Eigen::Matrix3d::Identity() - 0.5 * s + s * s / 6.0;
  const double angle = std::sqrt(angle2);
  return Eigen::Matrix3d::Identity() - (1.0 - std::cos(angle)) / angle2 * s +
         (angle - std::sin(angle)) / (angle2 * angle) * s * s;
}

void Preintegration::Add(const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& accel_m_s2,
                         double h_s, const ImuNoise& noise) {
  const Eigen::Vector3d turn = h_s * (gyro_rad_s - gyro_bias);
  const Eigen::Vector3d force = accel_m_s2 - accel_bias;
  const Eigen::Matrix3d half_back = ExpRotation(-0.5 * turn).toRotationMatrix();
  const Eigen::Matrix3d back = ExpRotation(-turn).toRotationMatrix();
  const Eigen::Matrix3d right = RightJacobian(turn);
  const Eigen::Matrix3d R_half = dq.toRotationMatrix() * half_back.transpose();
  const Eigen::Matrix3d by_attitude = -R_half * Skew(force) * half_back;

  const Eigen::Matrix3d half_by_gyro =
      half_back * dq_by_gyro - 0.5 * h_s * RightJacobian(0.5 * turn);
  const Eigen::Matrix3d a_by_gyro = -R_half * Skew(force) * half_by_gyro;
  dp_by_gyro += h_s * dv_by_gyro + 0.5 * h_s * h_s * a_by_gyro;
  dp_by_accel += h_s * dv_by_accel - 0.5 * h_s * h_s * R_half;
  dv_by_gyro += h_s * a_by_gyro;
  dv_by_accel -= h_s * R_half;
  dq_by_gyro = back * dq_by_gyro - h_s * right;

  Matrix9d A = Matrix9d::Identity();
  A.block<3, 3>(0, 0) = back;
  A.block<3, 3>(3, 0) = h_s * by_attitude;
  A.block<3, 3>(6, 0) = 0.5 * h_s * h_s * by_attitude;
  A.block<3, 3>(6, 3) = h_s * Eigen::Matrix3d::Identity();
  covariance = A * covariance * A.transpose();
  covariance.block<3, 3>(0, 0) +=
      noise.gyro_rad_s_sqrt_hz * noise.gyro_rad_s_sqrt_hz * h_s * right * right.transpose();
  const double velocity2 = noise.accel_m_s2_sqrt_hz * noise.accel_m_s2_sqrt_hz * h_s;
  covariance.block<3, 3>(3, 3).diagonal().array() += velocity2;
  covariance.block<3, 3>(6, 6).diagonal().array() += h_s * h_s * velocity2 / 3.0;
  covariance.block<3, 3>(3, 6).diagonal().array() += 0.5 * h_s * velocity2;
  covariance.block<3, 3>(6, 3).diagonal().array() += 0.5 * h_s * velocity2;

  const Eigen::Vector3d a = R_half * force;
  dp += h_s * dv + 0.5 * h_s * h_s * a;
  dv += h_s * a;
  dq = (dq * ExpRotation(turn)).normalized();
  dt_s += h_s;
}

}  // namespace polnav::nav
