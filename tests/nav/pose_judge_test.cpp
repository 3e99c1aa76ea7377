#include "nav/stereo/pose_judge.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/nav/synthetic_street.h"

namespace polnav::nav {
namespace {

// A frame 0.2 m further on than the keyframe that its points were first seen from. The IMU's word
// is good for 1 cm and 1 mrad, points are seen to a third of a pixel.
class PoseJudgeTest : public ::testing::Test {
 protected:
  // Seen from `from`; nearest_m and up to 12 m more away.
  void Add(int count, const Pose& from, bool proven, double nearest_m = 3.0) {
    std::uniform_real_distribution<double> uniform;
    std::normal_distribution<double> noise(0.0, 0.3);
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d landmark(1.2 * uniform(engine_) - 0.6, 0.6 * uniform(engine_) - 0.3,
                                     1.0 / (nearest_m + 12.0 * uniform(engine_)));
      StereoPixel seen{.disparity_px = 0.0};
      const auto e = Reproject(camera_, ViewpointOf(camera_, keyframe_), ViewpointOf(camera_, from),
                               landmark, seen, {1.0, 1.0});
      seen.uv_px = Eigen::Vector2d(noise(engine_), noise(engine_)) - e->residual.head<2>();
      seen.disparity_px = noise(engine_) - e->residual.z();
      views_.push_back({.id = views_.size(),
                        .host = ViewpointOf(camera_, keyframe_),
                        .landmark = landmark,
                        .pixel = seen,
                        .proven = proven});
    }
  }

  [[nodiscard]] PoseVerdict Judge(const Pose& by_imu) const { return Judge(by_imu, views_); }
  [[nodiscard]] PoseVerdict Judge(const Pose& by_imu, const std::vector<LandmarkView>& kept) const {
    Eigen::Matrix<double, 6, 1> sigmas;
    sigmas << 0.01, 0.01, 0.01, 1e-3, 1e-3, 1e-3;
    const PosePrior prior{by_imu, sigmas.cwiseAbs2().asDiagonal()};
    return JudgePose(camera_, {views_, kept, prior}, options_, 12);
  }

  [[nodiscard]] double ErrorOf(const PoseVerdict& verdict) const {
    return (verdict.solution.value().T_WB.p - truth_.p).norm();
  }

  RectifiedCamera camera_ = StereoRectifier(TestCalibration()).camera();
  Pose keyframe_;
  Pose truth_{Eigen::Quaterniond::Identity(), {0.2, 0.0, 0.0}};
  Pose wrong_{Eigen::Quaterniond::Identity(), {0.05, 0.0, 0.0}};
  PoseSolverOptions options_{.sigmas = {.position_px = 0.3, .disparity_px = 0.3},
                             .inlier_sigmas = 4.0};
  std::vector<LandmarkView> views_;
  std::mt19937_64 engine_{5};
};

TEST_F(PoseJudgeTest, NobodyIsWrongWhenBothAgree) {
  Add(60, truth_, true);
  Add(60, truth_, false);
  const PoseVerdict verdict = Judge(truth_);
  EXPECT_FALSE(verdict.imu_wrong || verdict.pictures_wrong);
  EXPECT_LT(ErrorOf(verdict), 0.01);
}

TEST_F(PoseJudgeTest, ProvenLandmarksConvictTheImu) {
  Add(60, truth_, true);
  Add(30, keyframe_, false);
  const PoseVerdict verdict = Judge(wrong_);
  EXPECT_TRUE(verdict.imu_wrong);
  EXPECT_LT(ErrorOf(verdict), 0.05);
}

// Points seen where the keyframe saw them, as drops on the lens are: more than of the scene.
TEST_F(PoseJudgeTest, ProvenLandmarksConvictTheOtherPoints) {
  Add(20, truth_, true);
  Add(60, keyframe_, false);
  const auto believed = SolvePose(camera_, views_, truth_, options_, 12);
  ASSERT_GT((believed.value().T_WB.p - truth_.p).norm(), 0.1);
  const PoseVerdict verdict = Judge(truth_);
  EXPECT_TRUE(verdict.pictures_wrong);
  EXPECT_FALSE(verdict.imu_wrong);
  EXPECT_LT(ErrorOf(verdict), 0.02);
}

TEST_F(PoseJudgeTest, WithoutWitnessesTheImuIsBelieved) {
  Add(60, keyframe_, false);
  const PoseVerdict verdict = Judge(truth_);
  EXPECT_TRUE(verdict.pictures_wrong);
  EXPECT_FALSE(verdict.solution);
}

// Proven landmarks that are all far away bear the IMU out, and would bear out much else: moving
// points near by, which the flow rejected, are no reason to doubt.
TEST_F(PoseJudgeTest, FarLandmarksThatAgreeWithTheImuDoNotConvictIt) {
  Add(15, truth_, true, 60.0);
  std::vector<LandmarkView> kept = views_;
  Add(40, wrong_, false);
  const PoseVerdict verdict = Judge(truth_, kept);
  EXPECT_FALSE(verdict.imu_wrong || verdict.pictures_wrong);
  EXPECT_LT(ErrorOf(verdict), 0.02);
}

// Far landmarks hold a pose so loosely that one wrong point near by drags it along.
TEST_F(PoseJudgeTest, OneWrongLandmarkDoesNotConvictTheImu) {
  Add(15, truth_, true, 60.0);
  Add(1, keyframe_, true, 3.0);
  std::vector<LandmarkView> kept(views_.begin(), views_.begin() + 15);
  Add(40, wrong_, false);
  const PoseVerdict verdict = Judge(truth_, kept);
  EXPECT_FALSE(verdict.imu_wrong || verdict.pictures_wrong);
}

// A coach that pulls away, proven as it stood there before, fills seven tenths of the view.
TEST_F(PoseJudgeTest, MostLandmarksMovingDoNotConvictTheImu) {
  Add(70, {truth_.q, truth_.p - Eigen::Vector3d(0.2, 0.0, 0.0)}, true);
  Add(30, truth_, true);
  EXPECT_FALSE(Judge(truth_).imu_wrong);
}

}  // namespace
}  // namespace polnav::nav
