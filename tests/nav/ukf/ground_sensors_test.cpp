#include "nav/ukf/ground_sensors.h"

#include <gtest/gtest.h>

#include "nav/inertial/options.h"

namespace polnav::nav::ukf {
namespace {

// F ahead of the IMU and above it, x forward, y to the right, z down.
GroundSensor Sensor() {
  GroundSensor sensor;
  sensor.T_IF = {Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0), {0.2, 0.0, 0.3}};
  sensor.calibration.T_BF = sensor.T_IF;
  return sensor;
}

// Level, heading east, IMU 0.1 m over the ground: F is 0.4 m up.
State Level() {
  State state;
  state.p_WI.z() = 0.1;
  state.P = Covariance::Identity() * 1e-12;
  return state;
}

TEST(GroundSensors, RangeOfALevelSensorIsItsHeight) {
  EXPECT_NEAR(RangeOf(Level(), Sensor(), Error::Zero()), 0.4, 1e-12);
}

// PX4Flow's signs (nav/api/measurements.h): forward motion turns the ground about y.
TEST(GroundSensors, FlowIsVelocityOverDistance) {
  State state = Level();
  state.v_WI = {0.1, 0.0, 0.0};
  EXPECT_LT((FlowOf(state, Sensor(), {}, Error::Zero()) - Eigen::Vector2d(0.0, 0.25)).norm(),
            1e-12);
  state.v_WI = {0.0, 0.1, 0.0};  // to the left: F's -y
  EXPECT_LT((FlowOf(state, Sensor(), {}, Error::Zero()) - Eigen::Vector2d(0.25, 0.0)).norm(),
            1e-12);
}

// Turning on the spot, F goes sideways by rate times lever arm and its own turn about z is none
// about x or y.
TEST(GroundSensors, TheLeverArmMovesTheSensor) {
  const FlowInterval turning{.rate_rad_s = {0.0, 0.0, 0.5}};
  const Eigen::Vector2d flow = FlowOf(Level(), Sensor(), turning, Error::Zero());
  EXPECT_LT((flow - Eigen::Vector2d(0.5 * 0.2 / 0.4, 0.0)).norm(), 1e-12);
}

// A turn of F by a small angle reads that angle: pitching up by w about the point F itself.
TEST(GroundSensors, APitchingSensorReadsItsRate) {
  GroundSensor sensor = Sensor();
  sensor.T_IF.p.setZero();
  const FlowInterval pitching{.rate_rad_s = {0.0, 0.5, 0.0}};  // about I's y, F's -y
  const Eigen::Vector2d flow = FlowOf(Level(), sensor, pitching, Error::Zero());
  EXPECT_LT((flow - Eigen::Vector2d(0.0, -0.5)).norm(), 1e-12);
}

// For small errors the unscented cross covariance is P times the derivative, which finite
// differences give: to the size of the errors, 1e-6, relative.
TEST(GroundSensors, CrossCovarianceIsTheModelsDerivative) {
  State state = Level();
  state.q_WI = Exp({0.05, -0.08, 0.7});
  state.v_WI = {0.12, -0.05, 0.02};
  state.gyro_bias = {0.01, -0.02, 0.015};
  const FlowInterval interval{
      .rate_rad_s = {0.3, -0.2, 0.4}, .gained_m_s = {0.01, 0.02, -0.01}, .duration_s = 0.02};
  const Expected<2> expected = ExpectFlow(state, Sensor(), interval);
  constexpr double kStep = 1e-5;
  for (Eigen::Index i = 0; i < kSize; ++i) {
    const Error step = kStep * Error::Unit(i);
    const Eigen::Vector2d derivative =
        (FlowOf(state, Sensor(), interval, step) - FlowOf(state, Sensor(), interval, -step)) /
        (2.0 * kStep);
    const Eigen::Vector2d got = expected.covariance_with_state.row(i).transpose() / 1e-12;
    EXPECT_LT((got - derivative).norm(), 1e-5 * (1.0 + derivative.norm())) << i;
  }
}

// The velocity gained within the interval was reckoned with the bias that errs: half an interval
// of that bias is missing from the mean velocity.
TEST(GroundSensors, AWrongAccelerometerBiasShowsWithinTheInterval) {
  const FlowInterval interval{.duration_s = 0.02};
  Error error = Error::Zero();
  error(kAccelBias) = 1.0;
  const Eigen::Vector2d flow = FlowOf(Level(), Sensor(), interval, error);
  EXPECT_NEAR(flow.y(), 0.5 * 0.02 * 1.0 / 0.4, 1e-12);
  // So does a wrong level, by gravity's share.
  Error tilt = Error::Zero();
  tilt(kTheta + 1) = 0.01;
  const double range_m = RangeOf(Level(), Sensor(), tilt);
  EXPECT_NEAR(FlowOf(Level(), Sensor(), interval, tilt).y(),
              -0.5 * 0.02 * kGravity_m_s2 * 0.01 / range_m, 1e-4);
}

}  // namespace
}  // namespace polnav::nav::ukf
