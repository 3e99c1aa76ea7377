// What the score says about biases whose errors are known.
#include "tools/testbed/bias_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "nav/inertial/options.h"
#include "tools/testbed/metrics.h"

namespace polnav::testbed {
namespace {

constexpr double kMilliG_m_s2 = 1e-3 * nav::kGravity_m_s2;
const double kDeg_s = nav::DegToRad(1.0);

std::vector<sim::Truth> TruthOf(int count) {
  std::vector<sim::Truth> truth(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    sim::Truth& t = truth[static_cast<std::size_t>(i)];
    t.stamp = i * nav::kNsPerSecond / 10;
    t.imu_bias.emplace();
    t.imu_bias->gyro_rad_s = {0.01, -0.02, 0.03};
    t.imu_bias->accel_m_s2 = {0.1, 0.2, -0.3};
  }
  return truth;
}

// Off by so much, with these sigmas; all axes alike.
std::vector<nav::Estimate> EstimatesOf(const std::vector<sim::Truth>& truth,
                                       const Eigen::Vector3d& gyro_deg_s, double gyro_sigma_deg_s,
                                       const Eigen::Vector3d& accel_mg, double accel_sigma_mg) {
  std::vector<nav::Estimate> estimates;
  for (const sim::Truth& t : truth) {
    nav::Estimate e{.stamp = t.stamp};
    nav::ImuBiases biases;
    biases.gyro_rad_s = t.imu_bias->gyro_rad_s + kDeg_s * gyro_deg_s;
    biases.accel_m_s2 = t.imu_bias->accel_m_s2 + kMilliG_m_s2 * accel_mg;
    biases.covariance.diagonal().head<3>().setConstant(std::pow(kDeg_s * gyro_sigma_deg_s, 2));
    biases.covariance.diagonal().tail<3>().setConstant(std::pow(kMilliG_m_s2 * accel_sigma_mg, 2));
    e.biases = biases;
    estimates.push_back(e);
  }
  return estimates;
}

TEST(BiasErrors, AreLengthsInDegreesASecondAndMilliG) {
  const auto truth = TruthOf(20);
  const auto score =
      ScoreBiases(truth, EstimatesOf(truth, {0.3, -0.4, 0.0}, 0.2, {0.0, 12.0, 5.0}, 4.0)).value();
  EXPECT_NEAR(score.gyro_deg_s.last, 0.5, 1e-9);
  EXPECT_NEAR(score.gyro_deg_s.last_sigma, 0.2 * std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(score.gyro_deg_s.nees_last.value(), 0.25 / 0.04, 1e-9);
  EXPECT_NEAR(score.gyro_deg_s.within_3_sigma, 1.0, 1e-12);
  EXPECT_NEAR(score.accel_mg.last, 13.0, 1e-9);
  EXPECT_NEAR(score.accel_mg.nees.value(), 169.0 / 16.0, 1e-9);
}

// By axis: one of three beyond.
TEST(BiasErrors, CountAxesWithinThreeSigma) {
  const auto truth = TruthOf(3);
  const auto score =
      ScoreBiases(truth, EstimatesOf(truth, {0.0, 0.31, 0.0}, 0.1, {1.0, 2.0, 2.9}, 1.0)).value();
  EXPECT_NEAR(score.gyro_deg_s.within_3_sigma, 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(score.accel_mg.within_3_sigma, 1.0, 1e-12);
}

TEST(BiasErrors, TheLastOneCountsAndNeesIsAMean) {
  const auto truth = TruthOf(2);
  auto estimates = EstimatesOf(truth, {0.2, 0.0, 0.0}, 0.1, Eigen::Vector3d::Zero(), 1.0);
  estimates[1].biases->gyro_rad_s = truth[1].imu_bias->gyro_rad_s;
  const auto score = ScoreBiases(truth, estimates).value();
  EXPECT_NEAR(score.gyro_deg_s.last, 0.0, 1e-12);
  EXPECT_NEAR(score.gyro_deg_s.nees_last.value(), 0.0, 1e-12);
  EXPECT_NEAR(score.gyro_deg_s.nees.value(), 0.5 * (4.0 + 0.0), 1e-9);
}

TEST(BiasErrors, NeedBothSides) {
  auto truth = TruthOf(2);
  auto estimates = EstimatesOf(truth, {0.2, 0.0, 0.0}, 0.1, Eigen::Vector3d::Zero(), 1.0);
  for (nav::Estimate& e : estimates) e.stamp += nav::kNsPerSecond / 20;  // amid two truths
  EXPECT_FALSE(ScoreBiases(truth, estimates).has_value());
  for (nav::Estimate& e : estimates) e.biases.reset();
  EXPECT_FALSE(ScoreBiases(truth, estimates).has_value());
  for (sim::Truth& t : truth) t.imu_bias.reset();
  EXPECT_FALSE(
      ScoreBiases(truth, EstimatesOf(TruthOf(2), {0.2, 0.0, 0.0}, 0.1, {0.0, 0.0, 0.0}, 1.0))
          .has_value());
}

// A covariance that is none has no NEES; three sigma of nothing is nothing.
TEST(BiasErrors, WithoutCovarianceThereIsNoNees) {
  const auto truth = TruthOf(1);
  const auto score =
      ScoreBiases(truth, EstimatesOf(truth, {0.0, 0.1, 0.0}, 0.0, {0.0, 0.0, 0.0}, 1.0)).value();
  EXPECT_FALSE(score.gyro_deg_s.nees_last.has_value());
  EXPECT_FALSE(score.gyro_deg_s.nees.has_value());
  EXPECT_NEAR(score.gyro_deg_s.within_3_sigma, 2.0 / 3.0, 1e-12);
}

// Every number of the score is a metric, and only of who estimates biases.
TEST(BiasErrors, AreMetrics) {
  for (const char* metric : {"gyro.last_deg_s", "gyro.last_sigma_deg_s", "gyro.within_3_sigma",
                             "gyro.nees_last", "gyro.nees", "accel.last_mg", "accel.last_sigma_mg",
                             "accel.within_3_sigma", "accel.nees_last", "accel.nees"}) {
    const std::string path = std::string("biases.") + metric;
    EXPECT_TRUE(IsMetric("estimators.ukf." + path)) << path;
    EXPECT_TRUE(IsMetric("estimators.ukf_no_polarization." + path)) << path;
    EXPECT_FALSE(IsMetric("estimators.ukf_paper." + path)) << path;
    const auto truth = TruthOf(1);
    const auto score =
        ScoreBiases(truth, EstimatesOf(truth, {0.0, 0.1, 0.0}, 1.0, {0.0, 0.0, 0.0}, 1.0));
    EXPECT_TRUE(MetricAt({{"biases", ToJson(*score)}}, path).has_value()) << path;
  }
}

}  // namespace
}  // namespace polnav::testbed
