// From where does one frame see the landmarks as it does?
//
// Huber-robust Gauss-Newton on e1-e3 of [Chu2021, eq. 15] over the newest pose alone, landmarks and
// keyframes held, then a verdict on each view.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "nav/api/estimate.h"
#include "nav/stereo/reprojection.h"

namespace polnav::nav {

// A landmark of the window as the newest frame sees it.
struct LandmarkView {
  std::uint64_t id = 0;
  Viewpoint host;
  Eigen::Vector3d landmark = Eigen::Vector3d::Zero();
  StereoPixel pixel;
  bool proven = false;  // two keyframes or more have seen it where it should be
};

struct PoseSolverOptions {
  PixelSigmas sigmas;
  double huber_sigmas = 1.5;
  double inlier_sigmas = 3.0;
  int max_iterations = 10;
};

// What motion is known to be possible: covariance of (dp, dtheta) in W.
struct PosePrior {
  Pose T_WB;
  Matrix6d covariance;
};

struct PoseSolution {
  Pose T_WB;
  std::vector<bool> inlier;  // one a view
  int inliers = 0;
  double nis = 0.0;  // chi2 of the inliers over its degrees of freedom, at the robust solution
  Matrix6d covariance = Matrix6d::Zero();  // of (dp, dtheta) in W, landmarks taken as known
};

// Starts from T_WB; with few views the prior decides. Nothing when fewer than min_inliers agree or
// the geometry is degenerate.
[[nodiscard]] std::optional<PoseSolution> SolvePose(
    const RectifiedCamera& camera, const std::vector<LandmarkView>& views, const Pose& T_WB,
    const PoseSolverOptions& options, int min_inliers, const std::optional<PosePrior>& prior = {});

}  // namespace polnav::nav
