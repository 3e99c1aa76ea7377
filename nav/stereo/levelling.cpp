#include "nav/stereo/levelling.h"

#include <algorithm>
#include <cmath>

namespace polnav::nav {
namespace {

constexpr double kGravity_m_s2 = 9.80665;
constexpr double kBiasTime_s = 30.0;

}  // namespace

void Levelling::Add(const ImuSample& sample) {
  force_sum_ += sample.accel_m_s2;
  ++force_count_;
}

void Levelling::AddMotion(TimeNs stamp, const Pose& motion) {
  const bool has_force = force_count_ > 0;
  // Without a force the interval's impulse would miss a part: it begins anew.
  if (!has_force) frames_.assign(1, {stamp, Pose{}, Eigen::Vector3d::Zero()});
  if (has_force) {
    const Pose before = frames_.empty() ? Pose{} : frames_.back().pose;
    frames_.push_back({stamp, before * motion, force_sum_ / force_count_});
  }
  force_sum_.setZero();
  force_count_ = 0;
}

void Levelling::Interrupt() { frames_.clear(); }

double Levelling::SpanSeconds() const {
  // The outermost frames only serve the velocities at their neighbours.
  return frames_.size() < 4 ? 0.0 : ToSeconds(frames_[frames_.size() - 2].stamp - frames_[1].stamp);
}

bool Levelling::FirstIsDue() const {
  return !first_taken_ && SpanSeconds() >= options_.first_interval_s;
}

Eigen::Vector3d Levelling::VelocityAt(std::size_t frame) const {
  const Frame& a = frames_[frame - 1];
  const Frame& b = frames_[frame + 1];
  return (b.pose.p - a.pose.p) / ToSeconds(b.stamp - a.stamp);
}

std::optional<LevelEdge> Levelling::TakeEdge() {
  const double span_s = SpanSeconds();
  if (span_s < (first_taken_ ? options_.interval_s : options_.first_interval_s)) {
    return std::nullopt;
  }
  const std::size_t end = frames_.size() - 2;
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();
  for (std::size_t i = 2; i <= end; ++i) {
    const Eigen::Quaterniond half_way = frames_[i - 1].pose.q.slerp(0.5, frames_[i].pose.q);
    impulse += ToSeconds(frames_[i].stamp - frames_[i - 1].stamp) * (half_way * frames_[i].force_B);
  }
  const Eigen::Vector3d up = (impulse - VelocityAt(end) + VelocityAt(1)) / span_s;
  const Eigen::Vector3d up_B = frames_.back().pose.q.conjugate() * up;
  const double velocity = std::sqrt(2.0) * options_.velocity_sigma_m_s / (kGravity_m_s2 * span_s);
  const double share = first_taken_ ? std::max(1.0, 2.0 * kBiasTime_s / span_s) : 1.0;
  const double bias = DegToRad(options_.bias_sigma_deg) * std::sqrt(share);
  first_taken_ = true;
  frames_.clear();
  return LevelEdge{.up_B = up_B.normalized(), .sigma_rad = std::hypot(velocity, bias)};
}

}  // namespace polnav::nav
