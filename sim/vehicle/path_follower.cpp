#include "sim/vehicle/path_follower.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/random.h"
#include "sim/vehicle/approach.h"

namespace polnav::sim {
namespace {

constexpr int kWeaves = 5;
constexpr double kShortestWeave_m = 40.0;
constexpr double kLongestWeave_m = 150.0;
constexpr double kWeaveOnset_m = 30.0;  // fades in, so that the start is on the centre line

constexpr double kSteerRate_rad_s = 0.5;
constexpr double kFeedback_m = 5.0;  // distance over which an offset is driven out
constexpr double kFeedbackDamping = 0.9;

constexpr double kAcceleration_m_s2 = 1.5;
constexpr double kJerk_m_s3 = 1.5;
constexpr double kSpeedTime_s = 1.5;
constexpr double kSpeedGain_1_s = 1.2;
constexpr double kSpeedIntegral_1_s2 = 0.4;
constexpr double kStopSpeed_m_s = 0.05;
constexpr double kBrakeHold_g = 0.5;
constexpr double kPedalRate_g_s = 2.0;  // force over weight, per second

}  // namespace

PathFollower::PathFollower(const CarOptions& options, const Track& track, std::uint64_t seed)
    : options_(options),
      track_(&track),
      rear_s_m_(-0.5 * options.wheelbase_m),
      force_n_(-Hold().brake_n) {
  const RandomStream stream(seed, 0, "vehicle/weave");
  double total = 0.0;
  for (int i = 0; i < kWeaves; ++i) {
    auto sample = stream.At(i);
    const double length =
        kShortestWeave_m * std::pow(kLongestWeave_m / kShortestWeave_m, sample.Uniform());
    waves_.push_back({2.0 * std::numbers::pi / length, 2.0 * std::numbers::pi * sample.Uniform(),
                      0.5 + sample.Uniform()});
    total += waves_.back().amplitude_m;
  }
  // Even with all waves in step the weave stays within its bound.
  for (Wave& wave : waves_) wave.amplitude_m *= options_.lateral_wander_m / total;
}

PathFollower::Weave PathFollower::WeaveAt(double s_m) const {
  Weave weave{};
  for (const Wave& wave : waves_) {
    const double phase = wave.k_rad_m * s_m + wave.phase_rad;
    weave.offset_m += wave.amplitude_m * std::sin(phase);
    weave.slope += wave.amplitude_m * wave.k_rad_m * std::cos(phase);
    weave.curvature_1_m -= wave.amplitude_m * wave.k_rad_m * wave.k_rad_m * std::sin(phase);
  }
  const double t = std::clamp(s_m / kWeaveOnset_m, 0.0, 1.0);
  const double f = t * t * t * (t * (6.0 * t - 15.0) + 10.0);
  const double f1 = 30.0 * t * t * (1.0 - t) * (1.0 - t) / kWeaveOnset_m;
  const double f2 = 60.0 * t * (1.0 - t) * (1.0 - 2.0 * t) / (kWeaveOnset_m * kWeaveOnset_m);
  return {f * weave.offset_m, f * weave.slope + f1 * weave.offset_m,
          f * weave.curvature_1_m + 2.0 * f1 * weave.slope + f2 * weave.offset_m};
}

double PathFollower::progress_m() const { return rear_s_m_ + 0.5 * options_.wheelbase_m; }

bool PathFollower::finished() const { return progress_m() >= options_.laps * track_->length_m(); }

Chassis::Controls PathFollower::Hold() const {
  return {.brake_n = kBrakeHold_g * options_.mass_kg * Chassis::kGravity_m_s2};
}

Chassis::Controls PathFollower::Drive(const nav::Pose& T_WB, const Eigen::Vector3d& v_WB_m_s) {
  const double speed = v_WB_m_s.dot(T_WB.q * Eigen::Vector3d::UnitX());
  const double steer = Steer(T_WB, speed);
  if (finished() && std::max(speed, reference_m_s_) < kStopSpeed_m_s) stopped_ = true;
  const double weight = options_.mass_kg * Chassis::kGravity_m_s2;
  const double wanted = stopped_ ? -kBrakeHold_g * weight : options_.mass_kg * Accelerate(speed);
  force_n_ = Approach(force_n_, wanted, kPedalRate_g_s * weight * Chassis::kStep_s);
  return {
      .steer_rad = steer, .drive_n = std::max(force_n_, 0.0), .brake_n = std::max(-force_n_, 0.0)};
}

double PathFollower::Steer(const nav::Pose& T_WB, double speed_m_s) {
  const Eigen::Vector3d rear = T_WB * Eigen::Vector3d(-0.5 * options_.wheelbase_m, 0.0, 0.0);
  const Track::Projection at = track_->Project(rear.head<2>());
  rear_s_m_ += std::remainder(at.s_m - rear_s_m_, track_->length_m());
  if (stopped_) return steer_rad_;

  // Steering acts late by its rate limit and the tyres' relaxation: look ahead by as much.
  const double ahead_m = 0.15 * std::max(speed_m_s, 0.0);
  const Weave here = WeaveAt(rear_s_m_);
  const Weave ahead = WeaveAt(rear_s_m_ + ahead_m);
  const double bend = track_->At(rear_s_m_ + ahead_m).curvature_1_m;
  const double curvature = bend / (1.0 - bend * ahead.offset_m) + ahead.curvature_1_m;

  const Eigen::Vector3d x_W = T_WB.q * Eigen::Vector3d::UnitX();
  const double course = std::atan2(at.tangent.y(), at.tangent.x()) + std::atan(here.slope);
  const double heading_error = nav::WrapPi(std::atan2(x_W.y(), x_W.x()) - course);
  const double offset_error = at.offset_m - here.offset_m;
  const double correction = offset_error / (kFeedback_m * kFeedback_m) +
                            2.0 * kFeedbackDamping * heading_error / kFeedback_m;
  const double most = nav::DegToRad(options_.max_steer_deg);
  const double wanted =
      std::clamp(std::atan(options_.wheelbase_m * (curvature - correction)), -most, most);
  steer_rad_ = Approach(steer_rad_, wanted, kSteerRate_rad_s * Chassis::kStep_s);
  return steer_rad_;
}

double PathFollower::Accelerate(double speed_m_s) {
  const double goal = finished() ? 0.0 : options_.speed_m_s;
  const double wanted =
      std::clamp((goal - reference_m_s_) / kSpeedTime_s, -kAcceleration_m_s2, kAcceleration_m_s2);
  reference_m_s2_ = Approach(reference_m_s2_, wanted, kJerk_m_s3 * Chassis::kStep_s);
  reference_m_s_ = std::max(reference_m_s_ + reference_m_s2_ * Chassis::kStep_s, 0.0);
  const double error = reference_m_s_ - speed_m_s;
  speed_error_m_ += error * Chassis::kStep_s;
  return reference_m_s2_ + kSpeedGain_1_s * error + kSpeedIntegral_1_s2 * speed_error_m_;
}

}  // namespace polnav::sim
