#include "nav/inertial/imu_track.h"

#include <cmath>

#include "nav/stereo/reprojection.h"

namespace polnav::nav {
namespace {

// Longer than a bump, shorter than a turn.
constexpr double kSlow_s = 3.0;

constexpr double kSettledTilt_rad = 0.005;
constexpr double kSettledSpeed_m_s = 0.5;

}  // namespace

ImuTrack::ImuTrack(const ImuCalibration& calibration, const InertialOptions& options)
    : options_(options),
      T_BI_(calibration.T_BI),
      noise_(NoiseOf(calibration, options)),
      buffer_(calibration.rate_hz, noise_) {}

void ImuTrack::Begin(TimeNs stamp, const Motion& motion) {
  at_ = stamp;
  sum_ = {.gyro_bias = motion.gyro_bias, .accel_bias = motion.accel_bias};
  complete_ = stamp >= distrusted_until_;
}

void ImuTrack::Distrust(TimeNs until) {
  distrusted_until_ = until;
  complete_ = false;
}

void ImuTrack::Advance(TimeNs stamp) {
  complete_ = buffer_.Integrate(at_, stamp, sum_) && complete_;
  at_ = stamp;
}

std::optional<InertialPrediction> ImuTrack::Predict(const Keyframe& keyframe,
                                                    const Matrix15d& covariance) const {
  if (!complete_) return std::nullopt;
  return nav::Predict(sum_, T_BI_, keyframe.T_WB, keyframe.motion, covariance);
}

void ImuTrack::Connect(const Motion& before, const Matrix15d& covariance, Keyframe& keyframe) {
  const auto sigma = [&](Eigen::Index at, Eigen::Index axes = 3) {
    return std::sqrt(covariance.diagonal().segment(at, axes).maxCoeff());
  };
  if (complete_) {
    keyframe.inertial = MakeInertialEdge(sum_, WalkSinceKeyframe(), T_BI_);
    // Tilt is about the two level axes; heading is another matter.
    keyframe.inertial->settled = sigma(3, 2) < kSettledTilt_rad && sigma(6) < kSettledSpeed_m_s;
    return;
  }
  const Motion unmoved{
      .v_WI = keyframe.motion.v_WI, .gyro_bias = before.gyro_bias, .accel_bias = before.accel_bias};
  keyframe.motion_prior = {unmoved, {options_.start_speed_sigma_m_s, sigma(9), sigma(12)}};
}

// The data sheet's walk, and for the gyroscopes the share of the rate that scale errors fake, as it
// grows or falls: from rest to a turn of w it has become the share of w. Bumps pass and leave
// nothing. An accelerometer's share of a vehicle's accelerations is too small to count.
BiasWalk ImuTrack::WalkSinceKeyframe() {
  const double keep = std::exp(-sum_.dt_s / kSlow_s);
  const double before2 = slow_rate_.squaredNorm();
  slow_rate_ = keep * slow_rate_ + (1.0 - keep) / sum_.dt_s * LogRotation(sum_.dq);
  const double fake =
      noise_.share_of_rate * std::sqrt(std::abs(slow_rate_.squaredNorm() - before2));
  const double root = std::sqrt(sum_.dt_s);
  return {std::hypot(noise_.gyro_walk_rad_s_sqrt_s * root, fake),
          noise_.accel_walk_m_s2_sqrt_s * root};
}

Matrix9d ImuTrack::StartCovariance() const {
  Eigen::Matrix<double, 9, 1> sigmas;
  sigmas << Eigen::Vector3d::Constant(options_.start_speed_sigma_m_s),
      Eigen::Vector3d::Constant(noise_.gyro_bias_rad_s),
      Eigen::Vector3d::Constant(noise_.accel_bias_m_s2);
  return sigmas.cwiseAbs2().asDiagonal();
}

}  // namespace polnav::nav
