// Where is the vehicle, from stereo features and the polarized sky?
//
// Stereo visual odometry over a sliding window [Chu2021, section 2]: flow rejection, pose,
// keyframe, bundle adjustment, marginalization; with a polarimeter given, its headings are edges of
// the same graph; with an IMU in the rig, its readings between keyframes are edges too: they
// predict each frame, tell moving objects from the scene, carry the estimate through darkness, and
// keep pitch and roll from drifting.
// Both of the paper's estimators are this class:
//   stereo               no polarization
//   stereo_polarization  with it
// Starts from what the scenario grants. Where nothing is seen it coasts, on the IMU or at constant
// velocity, and says so.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "nav/api/calibration.h"
#include "nav/api/estimate.h"
#include "nav/api/measurements.h"
#include "nav/graph/bundle_adjustment.h"
#include "nav/graph/loop_closing.h"
#include "nav/graph/window.h"
#include "nav/inertial/imu_track.h"
#include "nav/polarization/heading_fusion.h"
#include "nav/stereo/options.h"
#include "nav/stereo/pose_judge.h"
#include "nav/stereo/rectifier.h"
#include "nav/stereo/window_features.h"

namespace polnav::nav {

class StereoEstimator {
 public:
  // close_loops: places seen again correct the whole drive; needs features with descriptors.
  StereoEstimator(const StereoOptions& options, const StereoCalibration& calibration,
                  const std::optional<ImuCalibration>& imu, const StartPrior& start,
                  std::optional<HeadingFusion> polarization, bool close_loops = false);

  [[nodiscard]] Report Process(const Measurement& measurement);

 private:
  // Where the newest frame is expected, before anything in it is looked at.
  struct Expectation {
    PosePrior pose;
    bool by_imu = false;
    Eigen::Vector3d v_WI = Eigen::Vector3d::Zero();
    Eigen::Matrix<double, 3, 6> v_by_pose = Eigen::Matrix<double, 3, 6>::Zero();
  };

  [[nodiscard]] Report ProcessFeatures(const StereoFeatures& features);
  [[nodiscard]] Expectation Expect(TimeNs stamp);
  [[nodiscard]] PoseVerdict Solve(const StereoFeatures& features, const Expectation& expected,
                                  Report& report);
  void Follow(const PoseVerdict& verdict, const Expectation& expected, double dt_s);
  void Coast(const Expectation& expected);
  [[nodiscard]] bool NeedsKeyframe(int inliers) const;
  void AddKeyframe(const StereoFeatures& features, const std::vector<LandmarkView>& seen,
                   const std::optional<CoastSigmas>& coasted);
  void OptimizeWindow(const StereoFeatures& features, Report& report);
  [[nodiscard]] Estimate Answer(bool tracked) const;
  void Begin(const Matrix6d& covariance);

  StereoOptions options_;
  RectifiedCamera camera_;
  BundleAdjustmentOptions adjustment_;
  PoseSolverOptions solver_;
  std::optional<HeadingFusion> polarization_;
  std::optional<ImuTrack> imu_;
  std::optional<LoopCloser> loops_;

  Window window_;
  StateCovariance state_covariance_ = StateCovariance::Zero();  // of the newest keyframe
  int keyframe_views_ = 0;
  std::uint64_t next_keyframe_ = 0;
  RejectedTracks rejected_;

  TimeNs stamp_ = 0;  // of the newest frame
  TimeNs step_ = 0;   // between the newest two
  Pose T_WB_;         // at the newest frame; in O once loops are closed, see loop_closing.h
  Pose motion_;       // T_BpB from the frame before to the newest one
  Eigen::Vector3d v_WI_ = Eigen::Vector3d::Zero();  // at the newest frame, with an IMU
  Matrix6d covariance_ = Matrix6d::Zero();
};

}  // namespace polnav::nav
