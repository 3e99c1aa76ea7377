// The stereo estimator with an IMU in the rig.
#include <gtest/gtest.h>

#include "nav/stereo/estimator.h"
#include "tests/nav/synthetic_street.h"

namespace polnav::nav {
namespace {

constexpr int kImuPerFrame = 10;

ImuCalibration TestImu() {
  return {.rate_hz = 100.0,
          .gyro_noise_rad_s_sqrt_hz = DegToRad(0.0025),
          .accel_noise_m_s2_sqrt_hz = 2.5e-4,
          .gyro_bias_sigma_rad_s = DegToRad(0.1),
          .accel_bias_sigma_m_s2 = 0.015,
          .gyro_bias_instability_rad_s = DegToRad(7e-4),
          .accel_bias_instability_m_s2 = 3.5e-5};
}

// Stands for two seconds, speeds up at 2 m/s^2 to 6 m/s and drives on along the street.
struct Drive {
  RectifiedCamera camera = StereoRectifier(TestCalibration()).camera();
  SyntheticStreet street{camera, 90.0, 7};
  StartPrior start{.position_sigma_m = 0.01,
                   .heading_sigma_rad = DegToRad(0.3),
                   .level_sigma_rad = DegToRad(2.0)};
  StereoEstimator estimator{StereoOptions{}, TestCalibration(), TestImu(), start, std::nullopt};
  Eigen::Vector3d gyro_bias{0.001, -0.0008, 0.0012};
  Eigen::Vector3d accel_bias{0.01, -0.012, 0.008};
  Estimate last;

  static double WayAt(double t) {
    const double moving = std::max(0.0, t - 2.0);
    return moving < 3.0 ? moving * moving : 9.0 + 6.0 * (moving - 3.0);
  }
  [[nodiscard]] Pose TruthAt(int frame) const { return street.PoseAt(WayAt(0.1 * frame)); }

  void Feel(int frame) {
    constexpr double h = 0.1 / kImuPerFrame;
    for (int i = 1; i <= kImuPerFrame; ++i) {
      const double t = 0.1 * (frame - 1) + i * h;
      const Pose a = street.PoseAt(WayAt(t - h));
      const Pose b = street.PoseAt(WayAt(t));
      const auto velocity = [&](double s) {
        return Eigen::Vector3d(
            (street.PoseAt(WayAt(s + 1e-4)).p - street.PoseAt(WayAt(s - 1e-4)).p) / 2e-4);
      };
      ImuSample sample{.stamp = FromSeconds(t)};
      sample.gyro_rad_s = LogRotation(a.q.conjugate() * b.q) / h + gyro_bias;
      sample.accel_m_s2 =
          a.q.slerp(0.5, b.q).conjugate() *
              ((velocity(t) - velocity(t - h)) / h + Eigen::Vector3d(0.0, 0.0, kGravity_m_s2)) +
          accel_bias;
      (void)estimator.Process(sample);
    }
  }

  [[nodiscard]] StereoFeatures See(int frame, double noise_px = 0.2) {
    return street.See(TruthAt(frame), frame * kNsPerSecond / 10, noise_px);
  }

  void Go(int first, int end) {
    for (int k = first; k < end; ++k) {
      if (k > 0) Feel(k);
      last = *estimator.Process(See(k)).estimate;
    }
  }

  [[nodiscard]] double ErrorAt(int frame) const { return (last.T_WB.p - TruthAt(frame).p).norm(); }
};

TEST(InertialEstimator, AStandingStartIsLevelledByTheAccelerometer) {
  Drive drive;
  drive.Go(0, 20);
  const Eigen::Vector3d up = drive.last.T_WB.q.conjugate() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d up_true = drive.TruthAt(19).q.conjugate() * Eigen::Vector3d::UnitZ();
  // The bias of 0.0156 m/s^2 tilts by as much over gravity.
  EXPECT_LT((up - up_true).norm(), 1.2 * 0.0156 / kGravity_m_s2);
  // 0.13 degrees of bias and crooked axes, and what vision leaves of the velocities.
  EXPECT_LT(std::sqrt(drive.last.covariance(3, 3)), DegToRad(0.25));
}

// Three seconds without a picture at 6 m/s: velocity known to about 0.05 m/s, tilt to 0.1 degrees
// (0.017 m/s^2), so 0.15 m and 0.08 m; constant velocity would say 3 m of itself.
TEST(InertialEstimator, DarknessIsCoastedOnTheImu) {
  Drive drive;
  drive.Go(0, 90);
  for (int k = 90; k < 120; ++k) {
    drive.Feel(k);
    const Report blind = drive.estimator.Process(StereoFeatures{.stamp = k * kNsPerSecond / 10});
    EXPECT_FALSE(blind.estimate->tracked);
    drive.last = *blind.estimate;
  }
  EXPECT_LT(drive.ErrorAt(119), 0.5);
  const double sigma = std::sqrt(drive.last.covariance.diagonal().head<3>().sum());
  EXPECT_LT(drive.ErrorAt(119), 3.5 * sigma);
  EXPECT_LT(sigma, 1.0);
  drive.Go(120, 130);
  EXPECT_TRUE(drive.last.tracked);
  EXPECT_LT(drive.ErrorAt(129), 0.5);
}

// A coach that pulls away slowly fills seven tenths of the view. Vision alone would ride on it.
TEST(InertialEstimator, MostOfTheViewMovingIsNotTakenForTheScene) {
  Drive drive;
  drive.Go(0, 60);
  const double before = drive.ErrorAt(59);
  int rejected = 0;
  for (int k = 60; k < 90; ++k) {
    drive.Feel(k);
    const double t = 0.1 * (k - 60);
    const Pose truth = drive.TruthAt(k);
    const Eigen::Vector3d coach(0.75 * t * t, 0.0, 0.0);  // 1.5 m/s^2
    StereoFeatures seen = drive.See(k);
    const StereoFeatures moved = drive.street.See({truth.q, truth.p - coach}, seen.stamp, 0.2);
    std::map<std::uint64_t, FeatureObservation> by_id;
    for (const FeatureObservation& f : moved.features) by_id[f.id] = f;
    for (FeatureObservation& f : seen.features) {
      if (f.id % 10 < 7 && by_id.contains(f.id)) f = by_id[f.id];
    }
    const Report report = drive.estimator.Process(seen);
    rejected += report.flow_rejected;
    drive.last = *report.estimate;
  }
  EXPECT_GT(rejected, 0);  // each point once: it does not come back
  // Ridden on, it would be off by 6 m.
  EXPECT_LT(drive.ErrorAt(89), before + 0.3);
}

// The accelerometer's bias jumps by 2 m/s^2 for three seconds: believed, it would lead off by 9 m.
TEST(InertialEstimator, AnImuThatGoesWrongIsFoundOut) {
  Drive drive;
  drive.Go(0, 60);
  const Eigen::Vector3d bias = drive.accel_bias;
  drive.accel_bias.x() += 2.0;
  int wrong = 0;
  for (int k = 60; k < 90; ++k) {
    drive.Feel(k);
    const Report report = drive.estimator.Process(drive.See(k));
    wrong += report.imu_wrong;
    EXPECT_TRUE(report.estimate->tracked) << k;
    drive.last = *report.estimate;
  }
  EXPECT_GT(wrong, 0);
  EXPECT_LT(drive.ErrorAt(89), 0.5);
  drive.accel_bias = bias;
  drive.Go(90, 120);
  EXPECT_LT(drive.ErrorAt(119), 0.5);
}

// Missing readings break the thread; nothing is made up for them.
TEST(InertialEstimator, AGapInTheReadingsIsBridgedByVision) {
  Drive drive;
  drive.Go(0, 60);
  for (int k = 60; k < 80; ++k) drive.last = *drive.estimator.Process(drive.See(k)).estimate;
  EXPECT_TRUE(drive.last.tracked);
  drive.Go(80, 110);
  EXPECT_TRUE(drive.last.tracked);
  EXPECT_LT(drive.ErrorAt(109), 0.5);
}

TEST(InertialEstimator, ReadingsThatAreNotNumbersAreLeftOut) {
  Drive drive;
  drive.Go(0, 5);
  ImuSample broken{.stamp = 5 * kNsPerSecond / 10};
  broken.gyro_rad_s.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(drive.estimator.Process(broken).outcome, Outcome::kUnusable);
  drive.Go(5, 20);
  EXPECT_TRUE(drive.last.T_WB.p.allFinite());
  EXPECT_TRUE(drive.last.tracked);
}

}  // namespace
}  // namespace polnav::nav
