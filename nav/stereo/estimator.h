// Where is the vehicle, from stereo features and the polarized sky?
//
// Stereo visual odometry over a sliding window [Chu2021, section 2]: flow rejection, pose,
// keyframe, bundle adjustment, marginalization; with a polarimeter given, its headings are edges of
// the same graph; with an IMU in the rig, its accelerometer keeps pitch and roll from drifting.
// Both of the paper's estimators are this class:
//   stereo               no polarization
//   stereo_polarization  with it
// Starts from what the scenario grants. Fails where no texture is seen for long: it then coasts at
// constant velocity and says so.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "nav/api/calibration.h"
#include "nav/api/estimate.h"
#include "nav/api/measurements.h"
#include "nav/graph/bundle_adjustment.h"
#include "nav/graph/loop_closing.h"
#include "nav/graph/window.h"
#include "nav/polarization/heading_fusion.h"
#include "nav/stereo/levelling.h"
#include "nav/stereo/options.h"
#include "nav/stereo/pose_solver.h"
#include "nav/stereo/rectifier.h"

namespace polnav::nav {

class StereoEstimator {
 public:
  // close_loops: places seen again correct the whole drive; needs features with descriptors.
  StereoEstimator(const StereoOptions& options, const StereoCalibration& calibration,
                  const StartPrior& start, std::optional<HeadingFusion> polarization,
                  bool close_loops = false);

  [[nodiscard]] Report Process(const Measurement& measurement);

 private:
  [[nodiscard]] Report ProcessFeatures(const StereoFeatures& features);
  [[nodiscard]] Pose PredictPose(TimeNs stamp) const;
  [[nodiscard]] std::vector<LandmarkView> MatchLandmarks(const StereoFeatures& features) const;
  [[nodiscard]] std::vector<LandmarkView> RejectMoving(const std::vector<LandmarkView>& views,
                                                       const Pose& expected, Report& report);
  void Follow(const PoseSolution& solution, const std::vector<LandmarkView>& views);
  void Coast(const Pose& expected, TimeNs stamp);
  [[nodiscard]] bool NeedsKeyframe(int inliers) const;
  void AddKeyframe(const StereoFeatures& features, const std::vector<LandmarkView>& seen);
  void OptimizeWindow(Report& report);
  [[nodiscard]] Estimate Answer(bool tracked) const;
  void Restart(const StereoFeatures& features, Report& report);
  void ForgetRejected(const StereoFeatures& features);

  StereoOptions options_;
  RectifiedCamera camera_;
  StartPrior start_;
  BundleAdjustmentOptions adjustment_;
  PoseSolverOptions solver_;
  std::optional<HeadingFusion> polarization_;
  Levelling levelling_;
  std::optional<LoopCloser> loops_;

  Window window_;
  Matrix6d keyframe_covariance_ = Matrix6d::Zero();
  int keyframe_views_ = 0;
  std::uint64_t next_keyframe_ = 0;
  std::set<std::uint64_t> rejected_;  // tracks that do not belong to the static scene

  TimeNs stamp_ = 0;  // of the newest frame
  TimeNs step_ = 0;   // between the newest two
  Pose T_WB_;         // at the newest frame; in O once loops are closed, see loop_closing.h
  Pose motion_;       // T_BpB from the frame before to the newest one
  Matrix6d covariance_ = Matrix6d::Zero();
};

}  // namespace polnav::nav
