#include "sim/sensors/reference.h"

#include <cmath>
#include <stdexcept>

#include "sim/sensors/imu.h"  // kGravity_m_s2
#include "sim/sensors/rotation.h"

namespace polnav::sim {

Reference::Reference(const ReferenceOptions& options, std::uint64_t seed, std::uint64_t trial)
    : options_(options),
      stream_(seed, trial, "reference"),
      outage_stream_(seed, trial, "reference/outage") {
  const double tilt = nav::DegToRad(options.tilt_sigma_deg);
  sigma_ << tilt, tilt, nav::DegToRad(options.yaw_sigma_deg),  //
      options.horizontal_sigma_m, options.horizontal_sigma_m, options.vertical_sigma_m,
      Eigen::Vector3d::Constant(options.velocity_sigma_m_s);
}

std::optional<std::size_t> Reference::OutageAt(double t_s) const {
  for (std::size_t i = 0; i < options_.outages.size(); ++i) {
    const double elapsed_s = t_s - options_.outages[i].start_s;
    if (elapsed_s >= 0.0 && elapsed_s < options_.outages[i].duration_s) return i;
  }
  return std::nullopt;
}

Reference::Coasting Reference::BeginCoasting(std::size_t outage) const {
  const double turn_rad_s = nav::DegToRad(options_.outage_gyro_bias_deg_h) / 3600.0;
  const double bias_m_s2 = 1e-3 * kGravity_m_s2 * options_.outage_accel_bias_mg;
  const double level_m_s2 = kGravity_m_s2 * nav::DegToRad(options_.tilt_sigma_deg);
  RandomStream::Sample draw = outage_stream_.At(outage);
  Coasting coasting;
  coasting.outage = outage;
  coasting.begin = sigma_.cwiseProduct(wander_) + surplus_;
  coasting.turn_rad_s = turn_rad_s * GaussianVector(draw);
  coasting.acceleration_m_s2 = bias_m_s2 * GaussianVector(draw);
  const Eigen::Vector3d horizontal(1.0, 1.0, 0.0);
  coasting.acceleration_m_s2 += level_m_s2 * horizontal.cwiseProduct(GaussianVector(draw));
  coasting.jerk_m_s3 = kGravity_m_s2 * turn_rad_s * horizontal.cwiseProduct(GaussianVector(draw));
  return coasting;
}

Reference::Errors Reference::ErrorsAfter(const Coasting& coasting, double elapsed_s) {
  const double s = elapsed_s;
  const Eigen::Vector3d velocity = coasting.begin.tail<3>();
  Errors errors = coasting.begin;
  errors.head<3>() += s * coasting.turn_rad_s;
  errors.segment<3>(3) += s * velocity + s * s / 2.0 * coasting.acceleration_m_s2 +
                          s * s * s / 6.0 * coasting.jerk_m_s3;
  errors.tail<3>() += s * coasting.acceleration_m_s2 + s * s / 2.0 * coasting.jerk_m_s3;
  return errors;
}

// What the errors are beyond their wander; one sample on, at t_s.
void Reference::StepSurplus(double t_s) {
  surplus_ *= std::exp(-1.0 / (options_.rate_hz * options_.recovery_time_s));
  const std::optional<std::size_t> outage = OutageAt(t_s);
  if (!outage) {
    coasting_.reset();
    return;
  }
  if (!coasting_ || coasting_->outage != *outage) coasting_ = BeginCoasting(*outage);
  const double elapsed_s = t_s - options_.outages[*outage].start_s;
  surplus_ = ErrorsAfter(*coasting_, elapsed_s) - sigma_.cwiseProduct(wander_);
}

nav::ReferencePose Reference::Sample(const Truth& truth, std::uint64_t index) {
  if (index < next_index_) {
    throw std::logic_error("Reference::Sample: samples must be taken in order");
  }
  const double keep = std::exp(-1.0 / (options_.rate_hz * options_.correlation_time_s));
  Errors white = Errors::Zero();
  for (; next_index_ <= index; ++next_index_) {
    RandomStream::Sample draw = stream_.At(next_index_);
    // The first sample is drawn from the stationary distribution: the filter has converged.
    const double kept = next_index_ == 0 ? 0.0 : keep;
    const double fresh = std::sqrt(1.0 - kept * kept);
    for (int i = 0; i < sigma_.size(); ++i) {
      wander_[i] = kept * wander_[i] + fresh * draw.Gaussian();
      white[i] = options_.white_share * draw.Gaussian();
    }
    StepSurplus(static_cast<double>(next_index_) / options_.rate_hz);
  }

  const Errors error = sigma_.cwiseProduct(wander_ + white) + surplus_;
  nav::ReferencePose pose;
  pose.stamp = truth.stamp;
  pose.gnss_aided = !coasting_;
  pose.T_WB.q =
      (RotationOf({0.0, 0.0, error[2]}) * truth.T_WB.q * RotationOf({error[0], error[1], 0.0}))
          .normalized();
  pose.T_WB.p = truth.T_WB.p + error.segment<3>(3);
  pose.v_WB_m_s = truth.v_WB_m_s + error.tail<3>();
  return pose;
}

}  // namespace polnav::sim
