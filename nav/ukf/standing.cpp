#include "nav/ukf/standing.h"

#include <cmath>

#include "nav/inertial/options.h"

namespace polnav::nav::ukf {
namespace {

constexpr int kLeast = 20;
// A consumer gyroscope's noise is 0.05 deg/s at 100 Hz; a walk swings by 20 deg/s.
constexpr double kStill_rad_s = 0.02;
constexpr double kGravityWithin = 0.2;  // share by which the force may differ

}  // namespace

void Standing::Add(const Eigen::Vector3d& gyro_B_rad_s, const Eigen::Vector3d& force_B_m_s2) {
  ++count_;
  gyro_ += gyro_B_rad_s;
  force_ += force_B_m_s2;
  gyro_squares_ += gyro_B_rad_s.squaredNorm();
}

std::optional<StandingErrors> Standing::Errors() const {
  if (count_ < kLeast) return std::nullopt;
  const Eigen::Vector3d gyro = gyro_ / count_;
  const Eigen::Vector3d force = force_ / count_;
  const double scatter2 = gyro_squares_ / count_ - gyro.squaredNorm();
  const double beyond = force.norm() - kGravity_m_s2;
  if (scatter2 > kStill_rad_s * kStill_rad_s || std::abs(beyond) > kGravityWithin * kGravity_m_s2) {
    return std::nullopt;
  }
  return StandingErrors{
      .gyro_bias_rad_s = gyro,
      .accel_bias_m_s2 = beyond * force.normalized(),
      .q_LB = Eigen::Quaterniond::FromTwoVectors(force, Eigen::Vector3d::UnitZ())};
}

}  // namespace polnav::nav::ukf
