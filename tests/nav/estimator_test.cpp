#include "nav/stereo/estimator.h"

#include <gtest/gtest.h>

#include "nav/polarization/six_channel.h"
#include "tests/nav/synthetic_street.h"

namespace polnav::nav {
namespace {

struct Drive {
  RectifiedCamera camera = StereoRectifier(TestCalibration()).camera();
  SyntheticStreet street{camera, 60.0, 7};
  StartPrior start{.p_WB_m = Eigen::Vector3d::Zero(),
                   .position_sigma_m = 0.01,
                   .heading_rad = 0.0,
                   .heading_sigma_rad = DegToRad(0.3),
                   .level_sigma_rad = DegToRad(0.3)};
  StereoEstimator estimator{StereoOptions{}, TestCalibration(), std::nullopt, start, std::nullopt};
  Estimate last;
  double worst_m = 0.0;

  // 6 m/s along the street, ten frames a second.
  void Go(int first, int frames, double noise_px) {
    for (int k = first; k < first + frames; ++k) {
      const Pose truth = street.PoseAt(0.6 * k);
      const Report report = estimator.Process(street.See(truth, k * kNsPerSecond / 10, noise_px));
      last = *report.estimate;
      worst_m = std::max(worst_m, (last.T_WB.p - truth.p).norm());
    }
  }
};

TEST(StereoEstimator, FollowsExactFeaturesExactly) {
  Drive drive;
  drive.Go(0, 100, 0.0);
  // Nothing but the solvers' tolerances is left.
  EXPECT_LT(drive.worst_m, 0.01);
  EXPECT_TRUE(drive.last.tracked);
}

TEST(StereoEstimator, DriftsByLessThanOnePercentWithNoise) {
  Drive drive;
  drive.Go(0, 300, 0.2);
  EXPECT_LT(drive.worst_m, 0.01 * 0.6 * 300);
  EXPECT_GT(drive.last.covariance(0, 0), 0.0);
}

TEST(StereoEstimator, CoastsWithGrowingCovarianceAndComesBack) {
  Drive drive;
  drive.Go(0, 50, 0.1);
  const double before = drive.last.covariance(0, 0);
  for (int k = 50; k < 55; ++k) {
    const Report blind = drive.estimator.Process(StereoFeatures{.stamp = k * kNsPerSecond / 10});
    EXPECT_EQ(blind.outcome, Outcome::kUnusable);
    EXPECT_FALSE(blind.estimate->tracked);
    drive.last = *blind.estimate;
  }
  EXPECT_GT(drive.last.covariance(0, 0), before);
  EXPECT_LT((drive.last.T_WB.p - drive.street.PoseAt(0.6 * 54).p).norm(), 0.5);
  drive.Go(56, 20, 0.1);
  EXPECT_TRUE(drive.last.tracked);
}

TEST(StereoEstimator, LeavesOutFramesThatAreLateOrCameBefore) {
  Drive drive;
  drive.Go(0, 40, 0.1);
  const Estimate before = drive.last;
  const auto see = [&](int k) {
    return drive.street.See(drive.street.PoseAt(0.6 * k), k * kNsPerSecond / 10, 0.1);
  };
  for (const int k : {39, 35, 0}) {
    const Report report = drive.estimator.Process(see(k));
    EXPECT_EQ(report.outcome, Outcome::kUnusable) << k;
    EXPECT_FALSE(report.estimate) << k;
  }
  drive.Go(40, 20, 0.1);
  EXPECT_TRUE(drive.last.tracked);
  EXPECT_GT(drive.last.stamp, before.stamp);
  EXPECT_LT((drive.last.T_WB.p - drive.street.PoseAt(0.6 * 59).p).norm(), 0.4);
}

TEST(StereoEstimator, PointsThatMoveTogetherAreLeftOut) {
  Drive drive;
  drive.Go(0, 30, 0.05);
  StereoFeatures seen = drive.street.See(drive.street.PoseAt(0.6 * 30), 3 * kNsPerSecond, 0.05);
  // A fifth of the points drives to the right by 25 px.
  for (std::size_t i = 0; i < seen.features.size(); i += 5) {
    seen.features[i].uv_left_px.x() += 25.0;
    *seen.features[i].u_right_px += 25.0;
  }
  const Report report = drive.estimator.Process(seen);
  EXPECT_GT(report.flow_rejected, 10);
  EXPECT_LT((report.estimate->T_WB.p - drive.street.PoseAt(0.6 * 30).p).norm(), 0.1);
}

TEST(StereoEstimator, ReportsItsInsides) {
  Drive drive;
  drive.Go(0, 60, 0.2);
  int adjusted = 0;
  for (int k = 60; k < 80; ++k) {
    const Report report = drive.estimator.Process(
        drive.street.See(drive.street.PoseAt(0.6 * k), k * kNsPerSecond / 10, 0.2));
    EXPECT_LE(report.inliers + report.flow_rejected + report.pose_rejected, report.features);
    EXPECT_GT(report.window_landmarks, report.inliers / 2);
    EXPECT_EQ(report.window_keyframes, StereoOptions{}.window_keyframes);
    EXPECT_TRUE(report.vision_nis);
    const auto took_s = [&](Stage stage) {
      return report.stage_s[static_cast<std::size_t>(stage)];
    };
    EXPECT_GT(took_s(Stage::kPose), 0.0);
    EXPECT_EQ(took_s(Stage::kAdjustment) > 0.0, report.keyframes == 1);
    EXPECT_EQ(took_s(Stage::kCovariance) > 0.0, report.keyframes == 1);
    EXPECT_EQ(took_s(Stage::kLoops), 0.0);
    adjusted += report.keyframes;
  }
  EXPECT_GT(adjusted, 5);
}

// Error of the heading [rad] after 20 s along the street under a clear sky, from a start that is
// off by as much as its sigma.
struct SkyDrive {
  double error_rad = 0.0;
  double sigma_rad = 0.0;
};

SkyDrive DriveUnderTheSky(double start_error_deg) {
  const Eigen::Vector3d sun = Eigen::Vector3d(0.6, -0.7, 0.3).normalized();
  Drive drive;
  drive.start.heading_rad = DegToRad(start_error_deg);
  drive.start.heading_sigma_rad = DegToRad(start_error_deg);
  PolarizationOptions options{.reading_sigma_deg = 0.5, .correlated_sigma_deg = 0.0};
  StereoEstimator estimator(StereoOptions{}, TestCalibration(), std::nullopt, drive.start,
                            HeadingFusion(options, {}, [&](TimeNs) { return sun; }));
  Estimate last;
  Pose truth;
  for (int k = 0; k < 200; ++k) {
    truth = drive.street.PoseAt(0.6 * k);
    const Eigen::Vector3d e = truth.q.conjugate() * sun.cross(Eigen::Vector3d::UnitZ());
    PolarizationSample sample{.stamp = k * kNsPerSecond / 10};
    constexpr std::array<double, 6> kAnglesDeg = {0, 90, 60, 150, 120, 210};
    for (std::size_t i = 0; i < 6; ++i) {
      sample.channel[i] =
          0.3 + 0.15 * std::cos(2.0 * (std::atan2(e.y(), e.x()) - DegToRad(kAnglesDeg[i])));
    }
    (void)estimator.Process(sample);
    last = *estimator.Process(drive.street.See(truth, sample.stamp, 0.1)).estimate;
  }
  return {WrapPi(CompassHeading(last.T_WB.q) - CompassHeading(truth.q)),
          std::sqrt(last.covariance(5, 5))};
}

// Some 100 keyframes of two readings of 0.5 degrees each leave less than 0.1.
TEST(StereoEstimator, PolarizationPullsAWrongStartingHeadingBack) {
  const SkyDrive end = DriveUnderTheSky(2.0);
  EXPECT_LT(std::abs(end.error_rad), DegToRad(0.1));
  EXPECT_LT(end.sigma_rad, DegToRad(0.3));
}

// A start known to the quarter of the compass chooses the half turn; the sky does the rest.
TEST(StereoEstimator, PolarizationAloneFindsTheHeadingFromACoarseStart) {
  const SkyDrive end = DriveUnderTheSky(45.0);
  EXPECT_LT(std::abs(end.error_rad), DegToRad(0.3));
}

}  // namespace
}  // namespace polnav::nav
