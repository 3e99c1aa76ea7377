#include "nav/ukf/predict.h"

#include <gtest/gtest.h>

#include <random>

#include "nav/inertial/options.h"

namespace polnav::nav::ukf {
namespace {

const Eigen::Vector3d kGyro(0.4, -0.7, 0.9);
const Eigen::Vector3d kAccel(1.2, -0.8, 11.0);
constexpr double kStep = 0.01;

State WalkingRobot() {
  State s;
  s.q_WI = Exp({0.1, -0.05, 0.8});
  s.v_WI = {0.3, -0.2, 0.1};
  s.p_WI = {1.0, 2.0, 0.3};
  s.gyro_bias = {0.01, -0.02, 0.005};
  s.accel_bias = {0.1, 0.2, -0.1};
  s.slow(kGyroTurn - kNavigation) = 0.01;
  return s;
}

// Where the robot really goes if the nominal state errs by e, and by what that then errs:
// predict.h's equations, written once more for one robot.
Error ErrorAfter(const State& nominal, const State& nominal_after, const Error& e) {
  const Eigen::Quaterniond tilt = Exp(e.segment<3>(kTheta));
  const Eigen::Quaterniond q = tilt * nominal.q_WI;
  const Eigen::Vector3d v = tilt * (nominal.v_WI + e.segment<3>(kVelocity));
  const Eigen::Vector3d rate = kGyro - nominal.gyro_bias - e.segment<3>(kGyroBias) -
                               kGyro.z() * (nominal.GyroTurn() + e.segment<3>(kGyroTurn));
  const Eigen::Vector3d force = kAccel - nominal.accel_bias;
  const Eigen::Vector3d swing = force - Eigen::Vector3d(0.0, 0.0, kGravity_m_s2);
  Eigen::Matrix3d crooked;
  for (Eigen::Index k = 0; k < 3; ++k) {
    crooked.row(k) = e.segment<3>(kAccelSwing + 3 * k).transpose();
  }
  const Eigen::Vector3d felt = force - e.segment<3>(kAccelBias) - crooked * swing;
  const Eigen::Vector3d v_after =
      v + kStep * (q * Exp(0.5 * kStep * rate) * felt - Eigen::Vector3d(0.0, 0.0, kGravity_m_s2));
  Error after = e;
  const Eigen::Vector3d theta = Log(q * Exp(kStep * rate) * nominal_after.q_WI.conjugate());
  after.segment<3>(kTheta) = theta;
  after.segment<3>(kVelocity) = Exp(-theta) * v_after - nominal_after.v_WI;
  after.segment<3>(kPosition) =
      nominal.p_WI + e.segment<3>(kPosition) + 0.5 * kStep * (v + v_after) - nominal_after.p_WI;
  return after;
}

// With errors so small that nothing is curved: F P F^T, F by central differences.
TEST(UkfPredict, CarriesTheCovarianceAsTheMotionCarriesErrors) {
  const ProcessNoise silent{.sky_time_s = 1e18};
  State before = WalkingRobot();
  State after = before;
  Predict(kGyro, kAccel, kStep, FromSeconds(kStep), silent, after);
  Covariance F;
  for (Eigen::Index j = 0; j < kSize; ++j) {
    Error e = Error::Zero();
    e(j) = 1e-4;
    F.col(j) = (ErrorAfter(before, after, e) - ErrorAfter(before, after, -e)) / 2e-4;
  }
  std::mt19937_64 engine(11);
  std::normal_distribution<double> normal;
  const Covariance root = Covariance::NullaryExpr([&] { return 1e-6 * normal(engine); });
  before.P = root * root.transpose();
  after = before;
  Predict(kGyro, kAccel, kStep, FromSeconds(kStep), silent, after);
  const Covariance expected = F * before.P * F.transpose();
  const Eigen::ArrayXd sigmas = expected.diagonal().array().sqrt();
  // What is curved is 1e-6 of what is not; differences are good to 1e-8.
  EXPECT_LT(((after.P - expected).array() / (sigmas.matrix() * sigmas.matrix().transpose()).array())
                .abs()
                .maxCoeff(),
            1e-5);
}

// A force beside gravity makes of a scale of 1 percent what 1 percent of it makes in an interval.
TEST(UkfPredict, AnUncertainScaleMakesTheVelocityUncertain) {
  State s;
  s.P(kAccelSwing, kAccelSwing) = 1e-4;
  Predict(Eigen::Vector3d::Zero(), {2.0, 0.0, kGravity_m_s2}, kStep, FromSeconds(kStep),
          {.sky_time_s = 1e18}, s);
  EXPECT_NEAR(std::sqrt(s.P(kVelocity, kVelocity)), 0.01 * 2.0 * kStep, 1e-12);
  EXPECT_EQ(s.P(kVelocity + 1, kVelocity + 1), 0.0);
}

}  // namespace
}  // namespace polnav::nav::ukf
