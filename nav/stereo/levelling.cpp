#include "nav/stereo/levelling.h"

#include <cmath>

namespace polnav::nav {
namespace {

// Beyond these a vehicle is no longer standing: far above any MEMS sensor's bias, far below driving.
constexpr double kStandingRate_rad_s = 0.1;
constexpr double kStandingForce_m_s2 = 0.8;
constexpr double kGravity_m_s2 = 9.80665;

}  // namespace

std::optional<Eigen::Vector3d> Levelling::Add(const ImuSample& sample) {
  if (finished_) return std::nullopt;
  const bool standing = sample.gyro_rad_s.norm() < kStandingRate_rad_s &&
                        std::abs(sample.accel_m_s2.norm() - kGravity_m_s2) < kStandingForce_m_s2;
  if (!standing) {
    finished_ = true;
    return std::nullopt;
  }
  if (!begin_) begin_ = sample.stamp;
  sum_ += sample.accel_m_s2;
  if (ToSeconds(sample.stamp - *begin_) < time_s_) return std::nullopt;
  finished_ = true;
  return sum_.normalized();
}

}  // namespace polnav::nav
