#include "nav/graph/loop_closing.h"

#include <gtest/gtest.h>

#include <array>

#include "nav/graph/edges.h"
#include "nav/stereo/estimator.h"
#include "tests/nav/synthetic_street.h"

namespace polnav::nav {
namespace {

constexpr double kRadius_m = 20.0;
constexpr int kLapFrames = 210;  // of 0.6 m

// Three laps of a small circle with a camera whose focal length is believed to be 0.3 % too long.
// Returns the largest position error on each lap [m].
std::array<double, 3> WorstByLap(bool close_loops) {
  StereoCalibration believed = TestCalibration();
  for (CameraCalibration* c : {&believed.left, &believed.right}) {
    c->fx_px *= 1.003;
    c->fy_px *= 1.003;
  }
  SyntheticStreet street(StereoRectifier(TestCalibration()).camera(), kRadius_m, 5);
  const StartPrior start{.p_WB_m = Eigen::Vector3d::Zero(),
                         .position_sigma_m = 0.01,
                         .heading_sigma_rad = DegToRad(0.3),
                         .level_sigma_rad = DegToRad(0.3)};
  StereoEstimator estimator({}, believed, std::nullopt, start, std::nullopt, close_loops);
  std::array<double, 3> worst{};
  for (int k = 0; k < 3 * kLapFrames; ++k) {
    const Pose truth = street.PoseAt(0.6 * k);
    const auto seen = street.SeeDescribed(truth, k * kNsPerSecond / 10, 0.2);
    const Estimate estimate = *estimator.Process(seen).estimate;
    double& lap = worst[static_cast<std::size_t>(k / kLapFrames)];
    lap = std::max(lap, (estimate.T_WB.p - truth.p).norm());
  }
  return worst;
}

// Odometry is wrong by 0.3 % of the turn, a degree a lap, and more each lap. Closed, later laps are
// held to the first, and what they show of the drift corrects that one too.
TEST(LoopCloser, HoldsLaterLapsToTheFirstAndShedsTheDrift) {
  const std::array<double, 3> odometry = WorstByLap(false);
  const std::array<double, 3> closed = WorstByLap(true);
  EXPECT_GT(odometry[2], 1.5 * odometry[0]);
  EXPECT_LT(closed[1], closed[0]);
  EXPECT_LT(closed[2], closed[0]);
  EXPECT_LT(closed[2], 0.5 * odometry[2]);
}

TEST(LoopCloser, AMissingKeyframeIsABrokenContract) {
  LoopCloser loops({}, PriorFromCovariance({}, Matrix6d::Identity()));
  Window window;
  window.keyframes.push_back({.id = 1});
  Report report;
  EXPECT_THROW(loops.Add({}, window, Matrix6d::Identity(), {}, {}, report), std::logic_error);
}

}  // namespace
}  // namespace polnav::nav
