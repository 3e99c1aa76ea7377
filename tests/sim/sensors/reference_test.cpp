#include "sim/sensors/reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace polnav::sim {
namespace {

Truth Somewhere() {
  Truth truth;
  truth.stamp = 77;
  truth.T_WB.q = nav::LevelAttitude(2.0);
  truth.T_WB.p = {10.0, -4.0, 0.5};
  truth.v_WB_m_s = {3.0, 1.0, 0.0};
  return truth;
}

// Sums of squares over 2000 systems: a deviation to 1.6 percent of one axis; tolerance five.
// White noise of 5 percent adds 0.1 percent.
TEST(Reference, ErrsAsItsDataSheetSays) {
  const Truth truth = Somewhere();
  double yaw = 0.0;
  double tilt = 0.0;
  double east = 0.0;
  double up = 0.0;
  double speed = 0.0;
  for (std::uint64_t trial = 0; trial < 2000; ++trial) {
    const nav::ReferencePose pose = Reference({}, 1, trial).Sample(truth, 5);
    yaw += std::pow(nav::WrapPi(nav::CompassHeading(pose.T_WB.q) - 2.0), 2);
    tilt += std::pow((pose.T_WB.q * Eigen::Vector3d::UnitZ()).x(), 2);
    east += std::pow(pose.T_WB.p.x() - 10.0, 2);
    up += std::pow(pose.T_WB.p.z() - 0.5, 2);
    speed += std::pow(pose.v_WB_m_s.y() - 1.0, 2);
    EXPECT_EQ(pose.stamp, truth.stamp);
  }
  const auto rms = [](double square) { return std::sqrt(square / 2000.0); };
  EXPECT_NEAR(nav::RadToDeg(rms(yaw)), 0.05, 0.004);
  EXPECT_NEAR(nav::RadToDeg(rms(tilt)), 0.015, 0.0012);
  EXPECT_NEAR(rms(east), 0.02, 0.0016);
  EXPECT_NEAR(rms(up), 0.03, 0.0024);
  EXPECT_NEAR(rms(speed), 0.02, 0.0016);
}

// Correlation of first-order Gauss-Markov errors after one correlation time: 1/e. 4000 systems
// give a correlation to 1.6 percent.
TEST(Reference, ErrorsWanderWithTheCorrelationTime) {
  ReferenceOptions options;
  options.rate_hz = 1.0;
  options.correlation_time_s = 10.0;
  options.white_share = 0.0;
  const Truth truth = Somewhere();
  double product = 0.0;
  double square = 0.0;
  for (std::uint64_t trial = 0; trial < 4000; ++trial) {
    Reference reference(options, 1, trial);
    const double first = reference.Sample(truth, 0).T_WB.p.y() + 4.0;
    const double later = reference.Sample(truth, 10).T_WB.p.y() + 4.0;
    product += first * later;
    square += first * first;
  }
  EXPECT_NEAR(product / square, std::exp(-1.0), 0.08);
}

TEST(Reference, WithoutErrorsIsTheTruth) {
  ReferenceOptions options;
  options.tilt_sigma_deg = options.yaw_sigma_deg = 0.0;
  options.horizontal_sigma_m = options.vertical_sigma_m = 0.0;
  options.velocity_sigma_m_s = 0.0;
  const Truth truth = Somewhere();
  const nav::ReferencePose pose = Reference(options, 1, 0).Sample(truth, 3);
  EXPECT_LT(pose.T_WB.q.angularDistance(truth.T_WB.q), 1e-15);
  EXPECT_EQ(pose.T_WB.p, truth.T_WB.p);
  EXPECT_EQ(pose.v_WB_m_s, truth.v_WB_m_s);
}

TEST(Reference, ASkippedSampleChangesNoOther) {
  Reference all({}, 1, 0);
  Reference last({}, 1, 0);
  const Truth truth = Somewhere();
  nav::ReferencePose pose;
  for (std::uint64_t k = 0; k < 20; ++k) {
    pose = all.Sample(truth, k);
  }
  EXPECT_EQ(pose.T_WB.p, last.Sample(truth, 19).T_WB.p);
  EXPECT_THROW(static_cast<void>(all.Sample(truth, 19)), std::logic_error);
}

}  // namespace
}  // namespace polnav::sim
