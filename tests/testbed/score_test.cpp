// What the score says about estimates whose errors are known.
#include "tools/testbed/score.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tools/testbed/statistics.h"

namespace polnav::testbed {
namespace {

// Heading north at 10 m/s, 40 s: 400 m.
Trajectory StraightNorth() {
  Trajectory truth;
  for (int i = 0; i <= 400; ++i) {
    truth.push_back({i * 100'000'000LL, {nav::LevelAttitude(0.0), {0.0, 1.0 * i, 0.0}}});
  }
  return truth;
}

std::vector<nav::Estimate> EstimatesOf(const Trajectory& truth) {
  std::vector<nav::Estimate> estimates;
  for (const StampedPose& pose : truth) {
    nav::Estimate e{.stamp = pose.stamp, .T_WB = pose.T_WB};
    e.covariance = nav::Matrix6d::Identity();
    e.tracked = true;
    estimates.push_back(e);
  }
  return estimates;
}

TEST(Score, HeadingErrorIsEstimateMinusTruthClockwise) {
  const Trajectory truth = StraightNorth();
  std::vector<nav::Estimate> estimates = EstimatesOf(truth);
  for (nav::Estimate& e : estimates) e.T_WB.q = nav::LevelAttitude(nav::DegToRad(2.0));
  const auto score = Score(truth, estimates);
  ASSERT_TRUE(score.has_value());
  EXPECT_NEAR(score->heading_deg.mean, 2.0, 1e-9);
  EXPECT_NEAR(score->heading_deg.mean_abs, 2.0, 1e-9);
  EXPECT_NEAR(score->heading_deg.rmse, 2.0, 1e-9);
  EXPECT_NEAR(score->heading_deg.std, 0.0, 1e-9);
}

TEST(Score, HeadingErrorIsWrapped) {
  Trajectory truth = StraightNorth();
  std::vector<nav::Estimate> estimates = EstimatesOf(truth);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    truth[i].T_WB.q = nav::LevelAttitude(nav::DegToRad(179.0));
    estimates[i].T_WB.q = nav::LevelAttitude(nav::DegToRad(-179.0));
  }
  EXPECT_NEAR(Score(truth, estimates)->heading_deg.max, 2.0, 1e-9);
}

TEST(Score, SignedAndMagnitudeStatisticsDiffer) {
  const HeadingScore s = ScoreHeading({-3.0, 1.0, 2.0, 0.0});
  EXPECT_DOUBLE_EQ(s.mean, 0.0);
  EXPECT_DOUBLE_EQ(s.mean_abs, 1.5);
  EXPECT_DOUBLE_EQ(s.max, 3.0);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(14.0 / 4.0));
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(14.0 / 4.0));
}

TEST(Score, PositionErrorIsNotAligned) {
  const Trajectory truth = StraightNorth();
  std::vector<nav::Estimate> estimates = EstimatesOf(truth);
  for (nav::Estimate& e : estimates) e.T_WB.p += Eigen::Vector3d(3.0, 0.0, 4.0);
  const auto score = Score(truth, estimates);
  EXPECT_NEAR(score->position_m->error.rmse, 5.0, 1e-12);
  EXPECT_NEAR(score->position_m->horizontal_rmse, 3.0, 1e-12);
  EXPECT_FALSE(score->ate_m.has_value());  // a straight line does not determine an alignment
}

TEST(Score, DriftOfATooLongOdometryIsItsScaleError) {
  const Trajectory truth = StraightNorth();
  std::vector<nav::Estimate> estimates = EstimatesOf(truth);
  for (nav::Estimate& e : estimates) e.T_WB.p *= 1.02;
  const auto score = Score(truth, estimates);
  // Pairs end at the first metre of truth beyond 100 m of the estimate: 99 m of truth.
  EXPECT_NEAR(*score->drift_percent, 0.02 * 99.0, 1e-9);
  EXPECT_NEAR(score->rpe_1m->trans_m.mean, 0.02, 1e-9);
}

TEST(Score, ShortRunsHaveNoDrift) {
  Trajectory truth = StraightNorth();
  truth.resize(50);
  const auto score = Score(truth, EstimatesOf(truth));
  EXPECT_FALSE(score->drift_percent.has_value());
  EXPECT_FALSE(score->rpe_100m.has_value());
  EXPECT_TRUE(score->rpe_1m.has_value());
}

TEST(Score, NeesIsTheSquaredErrorInSigmas) {
  const Trajectory truth = StraightNorth();
  std::vector<nav::Estimate> estimates = EstimatesOf(truth);
  for (nav::Estimate& e : estimates) {
    e.T_WB.p += Eigen::Vector3d(0.2, 0.2, 0.2);
    e.T_WB.q = nav::LevelAttitude(0.03);
    e.covariance = nav::Matrix6d::Identity() * 0.01;  // sigmas 0.1 m and 0.1 rad
  }
  const auto score = Score(truth, estimates);
  EXPECT_NEAR(score->nees->position.value_or(0.0), 12.0, 1e-9);
  EXPECT_NEAR(score->nees->heading, 0.09, 1e-9);
  EXPECT_EQ(score->nees->heading_within_3_sigma, 1.0);
}

TEST(Score, HasNoNeesWithoutACovariance) {
  const Trajectory truth = StraightNorth();
  std::vector<nav::Estimate> estimates = EstimatesOf(truth);
  for (nav::Estimate& e : estimates) e.covariance.setZero();
  EXPECT_FALSE(Score(truth, estimates)->nees.has_value());
}

TEST(Score, CountsTrackedEstimates) {
  const Trajectory truth = StraightNorth();
  std::vector<nav::Estimate> estimates = EstimatesOf(truth);
  for (std::size_t i = 0; i < 101; ++i) estimates[i].tracked = false;
  EXPECT_NEAR(Score(truth, estimates)->tracked_fraction, 300.0 / 401.0, 1e-12);
}

TEST(Score, IsAbsentWithoutAnyAnswer) { EXPECT_FALSE(Score(StraightNorth(), {}).has_value()); }

TEST(HeadingSigma, OfALevelVehicleIsTheYawSigma) {
  nav::Estimate e;
  e.T_WB.q = nav::LevelAttitude(0.7);
  e.covariance(5, 5) = 0.04;
  e.covariance(3, 3) = 9.0;  // tilts do not turn a level vehicle
  EXPECT_NEAR(*HeadingSigma(e), 0.2, 1e-12);
}

// The heading's derivative against finite differences, of a vehicle that climbs 20 degrees.
TEST(HeadingSigma, OfATiltedVehicleFollowsTheGeometry) {
  const Eigen::Quaterniond q = nav::LevelAttitude(0.7) *
                               Eigen::AngleAxisd(-0.35, Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX());
  for (int axis = 0; axis < 3; ++axis) {
    nav::Estimate e;
    e.T_WB.q = q;
    e.covariance(3 + axis, 3 + axis) = 1.0;
    const double step = 1e-6;
    const Eigen::Quaterniond turned(Eigen::AngleAxisd(step, Eigen::Vector3d::Unit(axis)));
    const double slope = (nav::CompassHeading(turned * q) - nav::CompassHeading(q)) / step;
    EXPECT_NEAR(HeadingSigma(e).value_or(0.0), std::abs(slope), 1e-5) << "axis " << axis;
  }
}

TEST(Statistics, AreNumpysDefinitions) {
  const Statistics s = Summarize({1.0, 2.0, 4.0, 9.0});
  EXPECT_DOUBLE_EQ(s.mean, 4.0);
  EXPECT_DOUBLE_EQ(s.median, 3.0);
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(38.0 / 4.0));
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(102.0 / 4.0));
  EXPECT_DOUBLE_EQ(s.sse, 102.0);
  EXPECT_EQ(s.min, 1.0);
  EXPECT_EQ(s.max, 9.0);
  EXPECT_DOUBLE_EQ(Percentile({10.0, 20.0, 30.0}, 99.0), 29.8);
}

TEST(Statistics, OfADivergedEstimateAreNotNumbers) {
  const Statistics s = Summarize({1.0, std::numeric_limits<double>::quiet_NaN()});
  EXPECT_TRUE(std::isnan(s.rmse));
  EXPECT_TRUE(std::isnan(s.median));
  EXPECT_THROW((void)Summarize({}), std::logic_error);
}

}  // namespace
}  // namespace polnav::testbed
