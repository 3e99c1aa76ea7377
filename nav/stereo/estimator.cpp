#include "nav/stereo/estimator.h"

#include <cmath>
#include <utility>

#include "nav/graph/edges.h"
#include "nav/graph/marginalization.h"
#include "nav/stereo/flow_rejection.h"

namespace polnav::nav {
namespace {

Matrix6d StartCovariance(const StartPrior& start) {
  Eigen::Matrix<double, 6, 1> sigmas;
  sigmas << Eigen::Vector3d::Constant(start.position_sigma_m),
      Eigen::Vector2d::Constant(start.level_sigma_rad), start.heading_sigma_rad;
  return sigmas.cwiseAbs2().asDiagonal();
}

// What constant velocity misses within dt, of (dp, dtheta).
Eigen::Matrix<double, 6, 1> MotionSigmas(double dt_s) {
  Eigen::Matrix<double, 6, 1> sigmas;
  sigmas << Eigen::Vector3d::Constant(kCoastSpeedSigma_m_s * dt_s),
      Eigen::Vector3d::Constant(kCoastRateSigma_rad_s * dt_s);
  return sigmas;
}

}  // namespace

StereoEstimator::StereoEstimator(const StereoOptions& options, const StereoCalibration& calibration,
                                 const StartPrior& start, std::optional<HeadingFusion> polarization,
                                 bool close_loops)
    : options_(options),
      camera_(StereoRectifier(calibration).camera()),
      start_(start),
      adjustment_{.sigmas = {options.pixel_sigma_px, options.disparity_sigma_px},
                  .max_iterations = options.max_iterations},
      solver_{.sigmas = adjustment_.sigmas, .inlier_sigmas = options.inlier_sigmas},
      polarization_(std::move(polarization)),
      levelling_(options.levelling),
      T_WB_{LevelAttitude(start.heading_rad), start.p_WB_m},
      covariance_(StartCovariance(start)) {
  if (close_loops) loops_.emplace(options.loops, PriorFromCovariance(T_WB_, covariance_));
}

Report StereoEstimator::Process(const Measurement& measurement) {
  if (const auto* features = std::get_if<StereoFeatures>(&measurement)) {
    return ProcessFeatures(*features);
  }
  if (const auto* sample = std::get_if<ImuSample>(&measurement)) {
    levelling_.Add(*sample);
    return {.outcome = Outcome::kUsed};
  }
  const auto* light = std::get_if<PolarizationSample>(&measurement);
  if (light != nullptr && polarization_) return {.outcome = polarization_->Add(*light)};
  return {};
}

Report StereoEstimator::ProcessFeatures(const StereoFeatures& features) {
  Report report{.outcome = Outcome::kUsed, .features = static_cast<int>(features.features.size())};
  if (!window_.keyframes.empty() && features.stamp <= stamp_) {  // late, or the same once more
    report.outcome = Outcome::kUnusable;
    return report;
  }
  const TimeNs before = window_.keyframes.empty() ? features.stamp : stamp_;
  const Eigen::Quaterniond q_before = T_WB_.q;
  const Pose expected = PredictPose(features.stamp);
  const std::vector<LandmarkView> views = RejectMoving(MatchLandmarks(features), expected, report);
  const bool starting = window_.keyframes.empty();
  std::optional<PosePrior> prior;
  if (step_ > 0) prior = {expected, MotionSigmas(ToSeconds(features.stamp - stamp_))};
  const auto solution = SolvePose(camera_, views, expected, solver_, options_.min_inliers, prior);
  if (solution) {
    Follow(*solution, views);
    levelling_.AddMotion(features.stamp, motion_);
  } else {
    if (!starting) Coast(expected, features.stamp);
    levelling_.Interrupt();
  }
  step_ = features.stamp - before;
  stamp_ = features.stamp;
  if (polarization_) {
    report.gated_readings =
        polarization_->Advance(before, q_before, stamp_, T_WB_.q, covariance_(5, 5));
  }
  report.inliers = solution ? solution->inliers : 0;
  if (!solution) {
    report.outcome = starting ? Outcome::kUsed : Outcome::kUnusable;
    Restart(features, report);
    report.keyframes = 1;
  } else if (NeedsKeyframe(report.inliers)) {
    AddKeyframe(features, views);
    OptimizeWindow(report);
    if (loops_) loops_->Add(camera_, window_, features, solver_, report);
    report.keyframes = 1;
  }
  ForgetRejected(features);
  report.estimate = Answer(solution.has_value() || starting);
  return report;
}

Estimate StereoEstimator::Answer(bool tracked) const {
  Estimate estimate{.stamp = stamp_, .T_WB = T_WB_, .covariance = covariance_, .tracked = tracked};
  if (loops_) {
    estimate.T_WB = loops_->InWorld(T_WB_);
    estimate.covariance = loops_->covariance() + covariance_ - keyframe_covariance_;
  }
  return estimate;
}

Pose StereoEstimator::PredictPose(TimeNs stamp) const {
  if (step_ <= 0) return T_WB_;
  const double ratio = ToSeconds(stamp - stamp_) / ToSeconds(step_);
  const Pose motion{ExpRotation(ratio * LogRotation(motion_.q)), ratio * motion_.p};
  return T_WB_ * motion;
}

std::vector<LandmarkView> StereoEstimator::MatchLandmarks(const StereoFeatures& features) const {
  std::vector<LandmarkView> views;
  for (const FeatureObservation& f : features.features) {
    const auto found = window_.landmarks.find(f.id);
    if (found == window_.landmarks.end()) continue;
    const Keyframe& host = window_.keyframes[IndexOf(window_, found->second.host)];
    views.push_back({.id = f.id,
                     .T_WBh = &host.T_WB,
                     .landmark = found->second.coordinates,
                     .pixel = PixelOf(f)});
  }
  return views;
}

std::vector<LandmarkView> StereoEstimator::RejectMoving(const std::vector<LandmarkView>& views,
                                                        const Pose& expected, Report& report) {
  const std::vector<bool> verdicts =
      MovesWithScene(camera_, views, T_WB_, expected, options_.flow_threshold_px);
  std::vector<LandmarkView> kept;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (verdicts[i]) kept.push_back(views[i]);
  }
  report.flow_rejected = static_cast<int>(views.size() - kept.size());
  return kept;
}

// Takes over the solved pose; what it disagrees with does not come back.
void StereoEstimator::Follow(const PoseSolution& solution, const std::vector<LandmarkView>& views) {
  motion_ = T_WB_.Inverse() * solution.T_WB;
  T_WB_ = solution.T_WB;
  covariance_ = keyframe_covariance_ + solution.covariance;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!solution.inlier[i]) {
      rejected_.insert(views[i].id);
      window_.landmarks.erase(views[i].id);
    }
  }
}

void StereoEstimator::Coast(const Pose& expected, TimeNs stamp) {
  const double dt = ToSeconds(stamp - stamp_);
  T_WB_ = expected;
  const auto sigmas = MotionSigmas(dt);
  covariance_ += Matrix6d(sigmas.cwiseAbs2().asDiagonal());
}

bool StereoEstimator::NeedsKeyframe(int inliers) const {
  const Pose& last = window_.keyframes.back().T_WB;
  return levelling_.FirstIsDue() || (T_WB_.p - last.p).norm() > options_.keyframe_distance_m ||
         T_WB_.q.angularDistance(last.q) > DegToRad(options_.keyframe_angle_deg) ||
         inliers < options_.keyframe_overlap * keyframe_views_;
}

// The newest frame joins the window with what it sees of old landmarks and with new ones.
void StereoEstimator::AddKeyframe(const StereoFeatures& features,
                                  const std::vector<LandmarkView>& seen) {
  Keyframe keyframe{.id = next_keyframe_++, .stamp = stamp_, .T_WB = T_WB_};
  const bool first_levelling = levelling_.FirstIsDue();
  keyframe.level = levelling_.TakeEdge();
  if (first_levelling && polarization_) polarization_->Forget();  // taken with a guessed tilt
  if (polarization_) keyframe.heading = polarization_->TakeEdge(stamp_, T_WB_.q);
  window_.keyframes.push_back(keyframe);
  std::set<std::uint64_t> trusted;
  for (const LandmarkView& view : seen) trusted.insert(view.id);
  keyframe_views_ = 0;
  for (const FeatureObservation& f : features.features) {
    const auto found = window_.landmarks.find(f.id);
    const StereoPixel pixel = PixelOf(f);
    if (found != window_.landmarks.end()) {
      if (!trusted.contains(f.id)) continue;
      found->second.sightings.push_back({keyframe.id, pixel});
    } else if (pixel.disparity_px && !rejected_.contains(f.id)) {
      window_.landmarks[f.id] = {.host = keyframe.id,
                                 .coordinates = LandmarkOf(camera_, pixel),
                                 .sightings = {{keyframe.id, pixel}}};
    } else {
      continue;
    }
    ++keyframe_views_;
  }
}

void StereoEstimator::OptimizeWindow(Report& report) {
  if (!AdjustBundle(camera_, adjustment_, window_).usable) ++report.failed_solves;
  for (const std::uint64_t id :
       RemoveOutliers(camera_, adjustment_.sigmas, options_.inlier_sigmas, window_)) {
    rejected_.insert(id);
  }
  // motion_ stays: a correction of the whole window is not a motion of the vehicle.
  T_WB_ = window_.keyframes.back().T_WB;
  keyframe_covariance_ = NewestCovariance(camera_, adjustment_, window_);
  covariance_ = keyframe_covariance_;
  if (static_cast<int>(window_.keyframes.size()) <= options_.window_keyframes) return;
  MarginalizeOldest(camera_, adjustment_, window_);
}

// Begins a new window at the current pose: at the start, and when sight of the old one is lost.
void StereoEstimator::Restart(const StereoFeatures& features, Report& report) {
  window_ = {};
  window_.prior = PriorFromCovariance(T_WB_, covariance_);
  keyframe_covariance_ = covariance_;
  AddKeyframe(features, {});
  if (loops_) loops_->Add(camera_, window_, features, solver_, report);
}

// Track ids are never used again once lost, so only those still seen need to be remembered.
void StereoEstimator::ForgetRejected(const StereoFeatures& features) {
  std::set<std::uint64_t> seen;
  for (const FeatureObservation& f : features.features) {
    if (rejected_.contains(f.id)) seen.insert(f.id);
  }
  rejected_ = std::move(seen);
}

}  // namespace polnav::nav
