#include <gtest/gtest.h>

#include <random>

#include "nav/graph/bundle_adjustment.h"
#include "nav/graph/edges.h"
#include "nav/graph/marginalization.h"
#include "tests/nav/synthetic_street.h"

namespace polnav::nav {
namespace {

constexpr double kStep = 1e-6;

TEST(HeadingEdge, JacobianAgreesWithFiniteDifferences) {
  const Pose pose{ExpRotation({0.05, -0.08, 1.9}), {1, 2, 3}};
  const HeadingEdge edge{.heading_rad = 0.1,
                         .sigma_rad = 0.02,
                         .by_errors = SkyErrors::LinSpaced(1.0, -0.6),
                         .by_tilt = {0.3, -0.2},
                         .q_WB = ExpRotation({0.03, -0.1, 1.8})};
  const HeadingResidual e = EvaluateHeading(edge, pose);
  for (int k = 0; k < 6; ++k) {
    const Eigen::Matrix<double, 6, 1> d = kStep * Eigen::Matrix<double, 6, 1>::Unit(k);
    const double difference = (EvaluateHeading(edge, Perturb(pose, d)).residual -
                               EvaluateHeading(edge, Perturb(pose, -d)).residual) /
                              (2.0 * kStep);
    EXPECT_NEAR(difference, e.by_pose(k), 1e-6) << k;
  }
  for (int k = 0; k < kSkyErrors; ++k) {
    const SkyErrors d = kStep * SkyErrors::Unit(k);
    const double difference =
        (EvaluateHeading(edge, pose, d).residual - EvaluateHeading(edge, pose, -d).residual) /
        (2.0 * kStep);
    EXPECT_NEAR(difference, e.by_errors(k), 1e-6) << k;
  }
}

TEST(HeadingEdge, ALevelTurnToTheRightRaisesTheHeading) {
  const Pose north{LevelAttitude(0.0), Eigen::Vector3d::Zero()};
  const Pose east{LevelAttitude(0.5 * M_PI), Eigen::Vector3d::Zero()};
  const HeadingEdge edge{.heading_rad = 0.0, .sigma_rad = 1.0};
  EXPECT_NEAR(EvaluateHeading(edge, north).residual, 0.0, 1e-12);
  EXPECT_NEAR(EvaluateHeading(edge, east).residual, -0.5 * M_PI, 1e-12);
}

TEST(LevelEdge, JacobianAgreesWithFiniteDifferences) {
  const Pose pose{ExpRotation({0.05, -0.08, 1.9}), {1, 2, 3}};
  const LevelEdge edge{.up_B = Eigen::Vector3d(0.02, -0.03, 1.0).normalized(), .sigma_rad = 0.005};
  const LevelResidual e = EvaluateLevel(edge, pose);
  for (int k = 0; k < 6; ++k) {
    const Eigen::Matrix<double, 6, 1> d = kStep * Eigen::Matrix<double, 6, 1>::Unit(k);
    const Eigen::Vector2d difference = (EvaluateLevel(edge, Perturb(pose, d)).residual -
                                        EvaluateLevel(edge, Perturb(pose, -d)).residual) /
                                       (2.0 * kStep);
    EXPECT_LT((difference - e.by_pose.col(k)).norm(), 1e-6) << k;
  }
}

TEST(InverseLeftJacobian, IsTheDerivativeOfTheRotationVector) {
  const Eigen::Vector3d theta(0.3, -0.5, 0.7);
  const Eigen::Matrix3d J = InverseLeftJacobian(theta);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(k);
    const Eigen::Vector3d difference = (LogRotation(ExpRotation(d) * ExpRotation(theta)) -
                                        LogRotation(ExpRotation(-d) * ExpRotation(theta))) /
                                       (2.0 * kStep);
    EXPECT_LT((difference - J.col(k)).norm(), 1e-8);
  }
}

// A window of keyframes on a street, each point seen from all keyframes that can.
struct StreetWindow {
  using ErrorMatrix = Eigen::Matrix<double, kSkyErrors, kSkyErrors>;
  static constexpr double kErrors = 0.003;
  RectifiedCamera camera = StereoRectifier(TestCalibration()).camera();
  SyntheticStreet street{camera, 60.0, 1};
  BundleAdjustmentOptions options{.sigmas = {0.2, 0.2}, .huber_sigmas = 1e6, .max_iterations = 50};
  Window window;

  StreetWindow(int keyframes, double noise_px) {
    Matrix6d start = Matrix6d::Identity() * 1e-6;
    for (int k = 0; k < keyframes; ++k) {
      const Pose pose = street.PoseAt(1.2 * k);
      Add(pose, street.See(pose, FromSeconds(0.2 * k), noise_px));
    }
    Begin(start);
  }

  void Begin(const Matrix6d& start) {
    window.prior = PriorFromCovariance(window.keyframes.front().T_WB, start);
    AddErrors(window.errors, kErrors * kErrors * ErrorMatrix::Identity(), window.prior);
  }

  StateCovariance Covariance() const {
    return NewestCovariance(LinearizeWindow(camera, options, window));
  }

  void Add(const Pose& pose, const StereoFeatures& seen) {
    const std::uint64_t id = window.keyframes.empty() ? 0 : window.keyframes.back().id + 1;
    window.keyframes.push_back({.id = id, .stamp = seen.stamp, .T_WB = pose});
    for (const FeatureObservation& f : seen.features) {
      const StereoPixel pixel{f.uv_left_px, f.uv_left_px.x() - *f.u_right_px};
      const auto [it, fresh] = window.landmarks.try_emplace(f.id);
      if (fresh) it->second = {.host = id, .coordinates = LandmarkOf(camera, pixel)};
      it->second.sightings.push_back({id, pixel});
    }
  }
};

TEST(BundleAdjustment, RecoversDisturbedPosesFromExactSightings) {
  StreetWindow s(6, 0.0);
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.01);
  std::vector<Pose> truth;
  for (Keyframe& k : s.window.keyframes) truth.push_back(k.T_WB);
  for (std::size_t i = 1; i < s.window.keyframes.size(); ++i) {
    Eigen::Matrix<double, 6, 1> d;
    for (int k = 0; k < 6; ++k) d(k) = noise(random);
    s.window.keyframes[i].T_WB = Perturb(truth[i], d);
  }
  ASSERT_TRUE(AdjustBundle(s.camera, s.options, s.window).usable);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    // The function tolerance of 1e-4 ends the iteration some way before zero.
    EXPECT_LT(Difference(s.window.keyframes[i].T_WB, truth[i]).norm(), 1e-4) << i;
  }
}

TEST(BundleAdjustment, AHeadingEdgeTurnsTheWindowByItsWeight) {
  StreetWindow s(4, 0.0);
  Matrix6d start = Matrix6d::Identity() * 1e-6;
  const double sigma = 0.01;
  start(5, 5) = sigma * sigma;
  s.Begin(start);
  Keyframe& first = s.window.keyframes.front();
  const double before = CompassHeading(first.T_WB.q);
  first.heading = {.heading_rad = before + 0.004, .sigma_rad = sigma};
  ASSERT_TRUE(AdjustBundle(s.camera, s.options, s.window).usable);
  // Prior and edge are equally sure: the result lies half way.
  EXPECT_NEAR(WrapPi(CompassHeading(first.T_WB.q) - before), 0.002, 2e-5);
}

// Where the start is hardly known, position and heading are weaker than what ties the keyframes to
// each other by more digits than a double has.
TEST(Marginalization, WhatRoundingTakesIsNoReasonToFail) {
  for (const double variance : {1e6, 1e10, 1e12, 1e14}) {
    StreetWindow s(4, 0.0);
    s.Begin(Matrix6d::Identity() * variance);
    StateCovariance covariance;
    ASSERT_NO_THROW(covariance = s.Covariance()) << variance;
    ASSERT_TRUE(covariance.allFinite());
    EXPECT_GT(covariance.diagonal().head<3>().minCoeff(), 100.0) << variance;
  }
}

// A turn in the mounting is the heading's alone to tell and stays with its prior; what changes with
// the light's axis, while vision says how the drive turned, comes out, and outlives the keyframes
// that showed it.
TEST(BundleAdjustment, TheSkysHarmonicsAreFoundFromHowTheyChange) {
  StreetWindow s(6, 0.0);
  const double harmonic = 0.006;
  for (std::size_t i = 0; i < s.window.keyframes.size(); ++i) {
    const double axis = 0.5 * static_cast<double>(i);
    Keyframe& k = s.window.keyframes[i];
    SkyErrors by;
    by << 1.0, std::cos(2.0 * axis), std::sin(2.0 * axis), std::cos(4.0 * axis),
        std::sin(4.0 * axis);
    k.heading = {.heading_rad = CompassHeading(k.T_WB.q) + harmonic * by(2),
                 .sigma_rad = 1e-4,
                 .by_errors = by};
  }
  ASSERT_TRUE(AdjustBundle(s.camera, s.options, s.window).usable);
  EXPECT_NEAR(s.window.errors(2), harmonic, 0.1 * harmonic);
  EXPECT_LT(std::abs(s.window.errors(1)), 0.1 * harmonic);
  const double sigma = std::sqrt(s.Covariance()(17, 17));
  EXPECT_LT(sigma, 0.1 * StreetWindow::kErrors);
  MarginalizeOldest(s.camera, s.options, s.window);
  EXPECT_NEAR(std::sqrt(s.Covariance()(17, 17)), sigma, 1e-3 * sigma);
}

TEST(BundleAdjustment, OutliersAreRemovedAndNothingElse) {
  StreetWindow s(4, 0.0);
  const std::size_t before = s.window.landmarks.size();
  auto& victim = s.window.landmarks.begin()->second;
  victim.sightings.front().pixel.uv_px.x() += 30.0;
  const auto removed = RemoveOutliers(s.camera, s.options.sigmas, 3.0, s.window);
  ASSERT_EQ(removed.size(), 1U);
  EXPECT_EQ(s.window.landmarks.size(), before - 1);
}

// What is kept about a keyframe must equal what solving with it would have said: to first order
// the covariance of the newest pose is the same before and after.
TEST(Marginalization, KeepsTheNewestPosesCovariance) {
  StreetWindow s(6, 0.1);
  ASSERT_TRUE(AdjustBundle(s.camera, s.options, s.window).usable);
  const StateCovariance before = s.Covariance();
  MarginalizeOldest(s.camera, s.options, s.window);
  const StateCovariance after = s.Covariance();
  EXPECT_LT((after - before).norm(), 1e-6 * before.norm());
}

TEST(Marginalization, LeavesTheOptimumWhereItWas) {
  StreetWindow s(6, 0.1);
  ASSERT_TRUE(AdjustBundle(s.camera, s.options, s.window).usable);
  const Pose before = s.window.keyframes.back().T_WB;
  MarginalizeOldest(s.camera, s.options, s.window);
  ASSERT_TRUE(AdjustBundle(s.camera, s.options, s.window).usable);
  const auto moved = Difference(s.window.keyframes.back().T_WB, before);
  // Far below one sigma of the newest pose (about 5 mm and 0.2 mrad).
  EXPECT_LT(moved.head<3>().norm(), 5e-4);
  EXPECT_LT(moved.tail<3>().norm(), 2e-5);
}

// Half a second between keyframes at rest as the readings have it; the poses disagree, which is no
// matter here: what is known of the newest keyframe must not depend on what has slid out.
TEST(Marginalization, KeepsWhatTheImuKnows) {
  StreetWindow s(5, 0.0);
  const ImuNoise noise{.gyro_rad_s_sqrt_hz = 1e-4,
                       .accel_m_s2_sqrt_hz = 1e-3,
                       .gyro_bias_rad_s = 1e-3,
                       .accel_bias_m_s2 = 1e-2};
  Matrix15d start = 1e-4 * Matrix15d::Identity();
  s.window.inertial = true;
  s.window.prior = PriorFromCovariance(s.window.keyframes.front().T_WB, Motion{}, start);
  AddErrors({}, 1e-5 * StreetWindow::ErrorMatrix::Identity(), s.window.prior);
  for (std::size_t i = 1; i < s.window.keyframes.size(); ++i) {
    Preintegration sum;
    for (int k = 0; k < 20; ++k) sum.Add({0, 0, 0}, {0, 0, kGravity_m_s2}, 0.01, noise);
    s.window.keyframes[i].inertial = MakeInertialEdge(sum, {1e-5, 1e-4}, {});
  }
  const StateCovariance before = s.Covariance();
  MarginalizeOldest(s.camera, s.options, s.window);
  const StateCovariance after = s.Covariance();
  for (int k = 0; k < kState; ++k) EXPECT_NEAR(after(k, k) / before(k, k), 1.0, 1e-6) << k;
}

}  // namespace
}  // namespace polnav::nav
