#include "nav/stereo/estimator.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <utility>

#include "nav/graph/edges.h"
#include "nav/graph/marginalization.h"
#include "nav/stereo/flow_rejection.h"

namespace polnav::nav {
namespace {

// What a vehicle may do besides going on as before, without an IMU to tell: from one frame to the
// next a car brakes by about 0.5 m/s and turns in by about 3 deg/s.
constexpr double kCoastSpeedSigma_m_s = 0.5;
constexpr double kCoastRateSigma_rad_s = 0.05;

// What a frame may show besides what the IMU expects, however sure it is of itself: a reading that
// has gone wrong is found out by the pictures only if they are not held against it too narrowly.
constexpr double kImuSpeedSigma_m_s = 0.1;
constexpr double kImuRateSigma_rad_s = 0.01;

// An IMU found wrong is not asked for so long; what is still wrong then is found out again.
constexpr double kImuOnTrial_s = 1.0;

constexpr std::size_t kFirstKeyframes = 4;
constexpr double kFirstKeyframeInterval_s = 0.25;

Matrix6d StartCovariance(const StartPrior& start) {
  Eigen::Matrix<double, 6, 1> sigmas;
  sigmas << Eigen::Vector3d::Constant(start.position_sigma_m),
      Eigen::Vector2d::Constant(start.level_sigma_rad), start.heading_sigma_rad;
  return sigmas.cwiseAbs2().asDiagonal();
}

Matrix6d MotionCovariance(double position_m, double angle_rad) {
  Eigen::Matrix<double, 6, 1> sigmas;
  sigmas << Eigen::Vector3d::Constant(position_m), Eigen::Vector3d::Constant(angle_rad);
  return sigmas.cwiseAbs2().asDiagonal();
}

CoastSigmas SigmasOf(const Matrix6d& covariance) {
  return {std::sqrt(covariance.diagonal().head<3>().maxCoeff()),
          std::sqrt(covariance.diagonal().tail<3>().maxCoeff())};
}

}  // namespace

StereoEstimator::StereoEstimator(const StereoOptions& options, const StereoCalibration& calibration,
                                 const std::optional<ImuCalibration>& imu, const StartPrior& start,
                                 std::optional<HeadingFusion> polarization, bool close_loops)
    : options_(options),
      camera_(StereoRectifier(calibration).camera()),
      adjustment_{.sigmas = {options.pixel_sigma_px, options.disparity_sigma_px},
                  .max_iterations = options.max_iterations},
      solver_{.sigmas = adjustment_.sigmas, .inlier_sigmas = options.inlier_sigmas},
      polarization_(std::move(polarization)),
      T_WB_{LevelAttitude(start.heading_rad), start.p_WB_m},
      covariance_(StartCovariance(start)) {
  if (imu && options.use_imu) imu_.emplace(*imu, options.inertial);
  if (close_loops) loops_.emplace(options.loops, PriorFromCovariance(T_WB_, covariance_));
  window_.inertial = imu_.has_value();
  // Without a sky there is nothing to tell, and nothing that it could move.
  const SkyErrors sigmas = polarization_ ? polarization_->ErrorSigmas() : SkyErrors::Ones();
  state_covariance_.diagonal().tail<kSkyErrors>() = sigmas.cwiseAbs2();
  if (imu_) state_covariance_.block<9, 9>(6, 6) = imu_->StartCovariance();
}

Report StereoEstimator::Process(const Measurement& measurement) {
  if (const auto* features = std::get_if<StereoFeatures>(&measurement)) {
    return ProcessFeatures(*features);
  }
  const auto* sample = std::get_if<ImuSample>(&measurement);
  if (sample != nullptr && imu_) return {.outcome = imu_->Add(*sample)};
  const auto* light = std::get_if<PolarizationSample>(&measurement);
  if (light != nullptr && polarization_) return {.outcome = polarization_->Add(*light)};
  return {};
}

Report StereoEstimator::ProcessFeatures(const StereoFeatures& features) {
  Report report{.outcome = Outcome::kUsed, .features = static_cast<int>(features.features.size())};
  const bool starting = window_.keyframes.empty();
  if (!starting && features.stamp <= stamp_) {  // late, or the same once more
    report.outcome = Outcome::kUnusable;
    return report;
  }
  StageWatch watch(report.stage_s);
  const TimeNs before = starting ? features.stamp : stamp_;
  const Eigen::Quaterniond q_before = T_WB_.q;
  const Expectation expected = Expect(features.stamp);
  const PoseVerdict verdict = Solve(features, expected, report);
  const std::optional<PoseSolution>& solution = verdict.solution;
  if (solution) Follow(verdict, expected, ToSeconds(features.stamp - before));
  if (!solution && !starting) Coast(expected);
  step_ = features.stamp - before;
  stamp_ = features.stamp;
  if (polarization_) {
    report.gated_readings = polarization_->Advance(before, q_before, stamp_, T_WB_.q,
                                                   covariance_.bottomRightCorner<3, 3>());
    report.sky = polarization_->residuals();
  }
  if (solution) {
    report.inliers = solution->inliers;
    report.pose_rejected = static_cast<int>(verdict.views.size()) - solution->inliers;
    report.vision_nis = solution->nis;
  }
  watch.Lap(Stage::kPose);
  if (!solution || verdict.imu_wrong || NeedsKeyframe(report.inliers)) {
    if (!solution && !expected.by_imu) Begin(covariance_);
    std::optional<CoastSigmas> coasted;
    if (!solution) coasted = SigmasOf(expected.pose.covariance);
    AddKeyframe(features, solution ? verdict.views : std::vector<LandmarkView>{}, coasted);
    OptimizeWindow(features, report);
  }
  if (!solution && !starting) report.outcome = Outcome::kUnusable;
  rejected_.KeepOnly(features);
  report.window_keyframes = static_cast<int>(window_.keyframes.size());
  report.window_landmarks = static_cast<int>(window_.landmarks.size());
  report.estimate = Answer(solution.has_value() || starting);
  return report;
}

Estimate StereoEstimator::Answer(bool tracked) const {
  Estimate estimate{.stamp = stamp_, .T_WB = T_WB_, .covariance = covariance_, .tracked = tracked};
  if (loops_) {
    estimate.T_WB = loops_->InWorld(T_WB_);
    estimate.covariance =
        loops_->covariance() + covariance_ - state_covariance_.topLeftCorner<6, 6>();
  }
  return estimate;
}

// By the IMU; without, on as before.
StereoEstimator::Expectation StereoEstimator::Expect(TimeNs stamp) {
  if (window_.keyframes.empty()) return {.pose = {T_WB_, covariance_}};
  const double dt = ToSeconds(stamp - stamp_);
  if (imu_) {
    imu_->Advance(stamp);
    if (const auto p =
            imu_->Predict(window_.keyframes.back(), state_covariance_.topLeftCorner<15, 15>())) {
      const Matrix6d pose = p->covariance.topLeftCorner<6, 6>() +
                            MotionCovariance(kImuSpeedSigma_m_s * dt, kImuRateSigma_rad_s * dt);
      const Eigen::Matrix<double, 3, 6> by_pose =
          Eigen::LDLT<Matrix6d>(pose).solve(p->covariance.topRightCorner<6, 3>()).transpose();
      return {.pose = {p->T_WB, pose}, .by_imu = true, .v_WI = p->v_WI, .v_by_pose = by_pose};
    }
  }
  const double ratio = step_ > 0 ? dt / ToSeconds(step_) : 0.0;
  const Pose motion{ExpRotation(ratio * LogRotation(motion_.q)), ratio * motion_.p};
  return {.pose = {T_WB_ * motion,
                   MotionCovariance(kCoastSpeedSigma_m_s * dt, kCoastRateSigma_rad_s * dt)}};
}

PoseVerdict StereoEstimator::Solve(const StereoFeatures& features, const Expectation& expected,
                                   Report& report) {
  PoseQuestion question{
      .all = MatchLandmarks(camera_, window_, features), .kept = {}, .by_imu = expected.pose};
  const std::vector<bool> moves_with_scene = MovesWithScene(
      camera_, question.all, expected.pose, adjustment_.sigmas, options_.flow_gate_sigmas);
  for (std::size_t i = 0; i < question.all.size(); ++i) {
    if (moves_with_scene[i]) question.kept.push_back(question.all[i]);
  }
  report.flow_rejected = static_cast<int>(question.all.size() - question.kept.size());
  if (expected.by_imu) {
    PoseVerdict verdict = JudgePose(camera_, question, solver_, options_.min_inliers);
    if (verdict.imu_wrong) imu_->Distrust(features.stamp + FromSeconds(kImuOnTrial_s));
    report.imu_wrong = verdict.imu_wrong ? 1 : 0;
    report.pictures_wrong = verdict.pictures_wrong ? 1 : 0;
    return verdict;
  }
  auto solution =
      SolvePose(camera_, question.kept, expected.pose.T_WB, solver_, options_.min_inliers,
                step_ > 0 ? std::optional(expected.pose) : std::nullopt);
  return {.solution = std::move(solution), .views = std::move(question.kept)};
}

// Takes over the solved pose; what it disagrees with does not come back.
void StereoEstimator::Follow(const PoseVerdict& verdict, const Expectation& expected, double dt_s) {
  const PoseSolution& solution = *verdict.solution;
  const std::vector<LandmarkView>& views = verdict.views;
  motion_ = T_WB_.Inverse() * solution.T_WB;
  if (expected.by_imu && !verdict.imu_wrong) {
    v_WI_ = expected.v_WI + expected.v_by_pose * Difference(solution.T_WB, expected.pose.T_WB);
  } else if (dt_s > 0.0) {
    v_WI_ = (solution.T_WB.p - T_WB_.p) / dt_s;
  }
  T_WB_ = solution.T_WB;
  covariance_ = state_covariance_.topLeftCorner<6, 6>() + solution.covariance;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!solution.inlier[i]) {
      rejected_.Add(views[i].id);
      window_.landmarks.erase(views[i].id);
    }
  }
}

void StereoEstimator::Coast(const Expectation& expected) {
  T_WB_ = expected.pose.T_WB;
  if (expected.by_imu) v_WI_ = expected.v_WI;
  covariance_ += expected.pose.covariance;
}

bool StereoEstimator::NeedsKeyframe(int inliers) const {
  const Keyframe& last = window_.keyframes.back();
  // Velocity and level take a few keyframes to tell apart: a new window does not wait for them.
  const double most_s = window_.keyframes.size() < kFirstKeyframes
                            ? kFirstKeyframeInterval_s
                            : options_.inertial.keyframe_interval_s;
  const bool old = imu_ && stamp_ - last.stamp >= FromSeconds(most_s);
  return old || (T_WB_.p - last.T_WB.p).norm() > options_.keyframe_distance_m ||
         T_WB_.q.angularDistance(last.T_WB.q) > DegToRad(options_.keyframe_angle_deg) ||
         inliers < options_.keyframe_overlap * keyframe_views_;
}

// The newest frame joins the window with what it sees of old landmarks and with new ones.
void StereoEstimator::AddKeyframe(const StereoFeatures& features,
                                  const std::vector<LandmarkView>& seen,
                                  const std::optional<CoastSigmas>& coasted) {
  Keyframe keyframe{.id = next_keyframe_++, .stamp = stamp_, .T_WB = T_WB_, .coasted = coasted};
  if (polarization_) {
    keyframe.heading =
        polarization_->TakeEdge(stamp_, T_WB_.q, covariance_.bottomRightCorner<3, 3>());
  }
  if (imu_ && !window_.keyframes.empty()) {
    const Motion& before = window_.keyframes.back().motion;
    keyframe.motion = before;
    keyframe.motion.v_WI = v_WI_;
    imu_->Connect(before, state_covariance_.topLeftCorner<15, 15>(), keyframe);
  }
  window_.keyframes.push_back(keyframe);
  keyframe_views_ = AddSightings(camera_, features, seen, rejected_, window_);
}

void StereoEstimator::OptimizeWindow(const StereoFeatures& features, Report& report) {
  StageWatch watch(report.stage_s);
  report.keyframes = 1;
  const BundleAdjustmentSummary adjusted = AdjustBundle(camera_, adjustment_, window_);
  if (!adjusted.usable) ++report.failed_solves;
  for (const std::uint64_t id :
       RemoveOutliers(camera_, adjustment_.sigmas, options_.inlier_sigmas, window_)) {
    rejected_.Add(id);
    ++report.map_rejected;
  }
  watch.Lap(Stage::kAdjustment);
  // motion_ stays: a correction of the whole window is not a motion of the vehicle.
  const Keyframe& newest = window_.keyframes.back();
  T_WB_ = newest.T_WB;
  v_WI_ = newest.motion.v_WI;
  state_covariance_ = NewestCovariance(adjusted.equations);
  covariance_ = state_covariance_.topLeftCorner<6, 6>();
  if (imu_) imu_->Begin(stamp_, newest.motion);
  if (static_cast<int>(window_.keyframes.size()) > options_.window_keyframes) {
    MarginalizeOldest(camera_, adjustment_, window_);
  }
  watch.Lap(Stage::kCovariance);
  if (!loops_) return;
  loops_->Add(camera_, window_, covariance_, features, solver_, report);
  watch.Lap(Stage::kLoops);
}

// A new window at the current pose: at the start, and when the thread to the old one is lost.
void StereoEstimator::Begin(const Matrix6d& covariance) {
  const Motion motion = window_.keyframes.empty() ? Motion{} : window_.keyframes.back().motion;
  window_.keyframes.clear();
  window_.landmarks.clear();
  // What the sensors are off by is known as before; the velocity is not.
  if (imu_) {
    Matrix15d state = Matrix15d::Zero();
    state.topLeftCorner<6, 6>() = covariance;
    state.bottomRightCorner<9, 9>() = imu_->StartCovariance();
    state.bottomRightCorner<6, 6>() = state_covariance_.block<6, 6>(9, 9);
    window_.prior = PriorFromCovariance(T_WB_, motion, state);
  } else {
    window_.prior = PriorFromCovariance(T_WB_, covariance);
  }
  AddErrors(window_.errors, state_covariance_.bottomRightCorner<kSkyErrors, kSkyErrors>(),
            window_.prior);
}

}  // namespace polnav::nav
