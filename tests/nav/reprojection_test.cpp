#include "nav/stereo/reprojection.h"

#include <gtest/gtest.h>

#include "tests/nav/synthetic_street.h"

namespace polnav::nav {
namespace {

class ReprojectionTest : public ::testing::Test {
 protected:
  RectifiedCamera camera_ = StereoRectifier(TestCalibration()).camera();
  Pose host_{ExpRotation({0.1, -0.2, 0.9}), {3.0, -2.0, 0.5}};
  Pose target_{ExpRotation({0.12, -0.15, 0.97}), {4.1, -1.2, 0.6}};
  Eigen::Vector3d landmark_{0.2, -0.1, 0.08};
  StereoPixel seen_{.uv_px = {400.0, 200.0}, .disparity_px = 3.0};
  PixelSigmas sigmas_{.position_px = 0.5, .disparity_px = 0.4};

  std::optional<Reprojection> See(const Pose& host, const Pose& target,
                                  const Eigen::Vector3d& l) const {
    return Reproject(camera_, ViewpointOf(camera_, host), ViewpointOf(camera_, target), l, seen_,
                     sigmas_);
  }
  Eigen::Vector3d Residual(const Pose& host, const Pose& target, const Eigen::Vector3d& l) const {
    return See(host, target, l)->residual;
  }
};

// Central differences with step 1e-6: truncation about 1e-12 times the third derivative (some
// 1e4 px/rad^3), rounding about 1e-16 * 1e3 px / 1e-6 = 1e-7.
constexpr double kStep = 1e-6;
constexpr double kDifferenceTolerance = 1e-4;

TEST_F(ReprojectionTest, JacobiansAgreeWithFiniteDifferences) {
  const auto e = See(host_, target_, landmark_);
  ASSERT_TRUE(e);
  for (int k = 0; k < 6; ++k) {
    const Eigen::Matrix<double, 6, 1> d = kStep * Eigen::Matrix<double, 6, 1>::Unit(k);
    const Eigen::Vector3d by_host = (Residual(Perturb(host_, d), target_, landmark_) -
                                     Residual(Perturb(host_, -d), target_, landmark_)) /
                                    (2.0 * kStep);
    const Eigen::Vector3d by_target = (Residual(host_, Perturb(target_, d), landmark_) -
                                       Residual(host_, Perturb(target_, -d), landmark_)) /
                                      (2.0 * kStep);
    EXPECT_LT((by_host - e->by_host.col(k)).norm(), kDifferenceTolerance) << k;
    EXPECT_LT((by_target - e->by_target.col(k)).norm(), kDifferenceTolerance) << k;
  }
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(k);
    const Eigen::Vector3d by_landmark =
        (Residual(host_, target_, landmark_ + d) - Residual(host_, target_, landmark_ - d)) /
        (2.0 * kStep);
    EXPECT_LT((by_landmark - e->by_landmark.col(k)).norm(), kDifferenceTolerance) << k;
  }
}

TEST_F(ReprojectionTest, MovingHostAndTargetTogetherChangesNothing) {
  const auto e = See(host_, target_, landmark_);
  // A common translation; a common turn about W's origin moves both positions too.
  const Eigen::Matrix3d shift = e->by_host.leftCols<3>() + e->by_target.leftCols<3>();
  EXPECT_LT(shift.norm(), 1e-9);
  const Eigen::Matrix3d turn =
      e->by_host.rightCols<3>() - e->by_host.leftCols<3>() * Skew(host_.p) +
      e->by_target.rightCols<3>() - e->by_target.leftCols<3>() * Skew(target_.p);
  EXPECT_LT(turn.norm(), 1e-9);
}

TEST_F(ReprojectionTest, DisparityIsBaselineTimesFocalLengthOverDepth) {
  seen_ = {.uv_px = {camera_.cx_px, camera_.cy_px}, .disparity_px = 350.0 * 0.12 / 8.0};
  const Eigen::Vector3d l = LandmarkOf(camera_, seen_);
  EXPECT_NEAR(l.z(), 1.0 / 8.0, 1e-12);
  EXPECT_LT(Residual(host_, host_, l).norm(), 1e-12);
}

TEST_F(ReprojectionTest, APointAtInfinityIsSeenAndOneBehindIsNot) {
  landmark_.z() = 0.0;
  EXPECT_TRUE(See(host_, target_, landmark_));
  const Pose turned{
      target_.q * Eigen::Quaterniond(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ())), target_.p};
  EXPECT_FALSE(See(host_, turned, landmark_));
}

TEST(Rotation, LogUndoesExpUpToHalfATurn) {
  for (const double angle : {0.0, 1e-12, 1e-5, 0.3, 3.1}) {
    const Eigen::Vector3d theta = angle * Eigen::Vector3d(0.6, -0.64, 0.48);
    EXPECT_LT((LogRotation(ExpRotation(theta)) - theta).norm(), 1e-12) << angle;
  }
}

}  // namespace
}  // namespace polnav::nav
