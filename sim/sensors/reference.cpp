#include "sim/sensors/reference.h"

#include <cmath>
#include <stdexcept>

#include "sim/sensors/rotation.h"

namespace polnav::sim {

Reference::Reference(const ReferenceOptions& options, std::uint64_t seed, std::uint64_t trial)
    : options_(options), stream_(seed, trial, "reference") {
  const double tilt = nav::DegToRad(options.tilt_sigma_deg);
  sigma_ << tilt, tilt, nav::DegToRad(options.yaw_sigma_deg),  //
      options.horizontal_sigma_m, options.horizontal_sigma_m, options.vertical_sigma_m,
      Eigen::Vector3d::Constant(options.velocity_sigma_m_s);
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
  }

  const Errors error = sigma_.cwiseProduct(wander_ + white);
  nav::ReferencePose pose;
  pose.stamp = truth.stamp;
  pose.T_WB.q =
      (RotationOf({0.0, 0.0, error[2]}) * truth.T_WB.q * RotationOf({error[0], error[1], 0.0}))
          .normalized();
  pose.T_WB.p = truth.T_WB.p + error.segment<3>(3);
  pose.v_WB_m_s = truth.v_WB_m_s + error.tail<3>();
  return pose;
}

}  // namespace polnav::sim
