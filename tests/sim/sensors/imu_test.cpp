#include "sim/sensors/imu.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "sim/sensors/rotation.h"

namespace polnav::sim {
namespace {

constexpr nav::TimeNs kStep = 10'000'000;  // 100 Hz

ImuOptions Perfect() { return ImuPreset("perfect"); }

Truth AtRest(nav::TimeNs stamp, const Eigen::Quaterniond& q_WB = Eigen::Quaterniond::Identity()) {
  Truth truth;
  truth.stamp = stamp;
  truth.T_WB.q = q_WB;
  return truth;
}

// A tumbling, accelerating body: any smooth motion does.
Truth Tumbling(nav::TimeNs stamp) {
  const double t = nav::ToSeconds(stamp);
  Truth truth = AtRest(stamp, RotationOf({0.5 * std::sin(t), 0.3 * std::cos(1.7 * t), 0.8 * t}));
  truth.v_WB_m_s = {3.0 * std::sin(0.6 * t), 2.0 * t, std::cos(2.0 * t)};
  return truth;
}

// Up is what keeps a resting body from falling.
TEST(Imu, AtRestFeelsOneGUpwards) {
  Imu imu(Perfect(), 1, 0);
  const Eigen::Quaterniond q_WB = RotationOf({0.3, -0.2, 1.0});
  const nav::ImuSample sample = imu.Sample(AtRest(0, q_WB), AtRest(kStep, q_WB), 0);
  EXPECT_LT((q_WB * sample.accel_m_s2 - Eigen::Vector3d(0.0, 0.0, 9.80665)).norm(), 1e-13);
  EXPECT_LT(sample.gyro_rad_s.norm(), 1e-13);
  EXPECT_EQ(sample.stamp, kStep);
}

// Perfect readings hold the whole motion: a minute of them, integrated, is the truth to rounding
// (6000 steps of a few 1e-16, of speeds to 120 m/s).
TEST(Imu, PerfectReadingsIntegrateBackToTheTruth) {
  Imu imu(Perfect(), 1, 0);
  Eigen::Quaterniond q = Tumbling(0).T_WB.q;
  Eigen::Vector3d v = Tumbling(0).v_WB_m_s;
  for (nav::TimeNs k = 0; k < 6000; ++k) {
    const nav::ImuSample sample =
        imu.Sample(Tumbling(k * kStep), Tumbling((k + 1) * kStep), static_cast<std::uint64_t>(k));
    const Eigen::Vector3d turn = sample.gyro_rad_s * 0.01;
    const Eigen::Quaterniond q_mid = q * RotationOf(0.5 * turn);
    v += 0.01 * (q_mid * sample.accel_m_s2 - Eigen::Vector3d(0.0, 0.0, kGravity_m_s2));
    q = (q * RotationOf(turn)).normalized();
  }
  EXPECT_LT(q.angularDistance(Tumbling(6000 * kStep).T_WB.q), 1e-11);
  EXPECT_LT((v - Tumbling(6000 * kStep).v_WB_m_s).norm(), 1e-8);
}

// 20000 readings at rest: the deviation of 100 Hz noise is the density times 10, known to 0.5
// percent; tolerance six of these. No walk and no bias, so nothing else spreads them.
TEST(Imu, WhiteNoiseHasTheDensityAsked) {
  ImuOptions options = Perfect();
  options.gyro_noise_deg_s_sqrt_hz = 0.01;
  options.accel_noise_mg_sqrt_hz = 0.1;
  Imu imu(options, 1, 0);
  double gyro = 0.0;
  double accel = 0.0;
  for (nav::TimeNs k = 0; k < 20000; ++k) {
    const nav::ImuSample sample =
        imu.Sample(AtRest(k * kStep), AtRest((k + 1) * kStep), static_cast<std::uint64_t>(k));
    gyro += sample.gyro_rad_s.x() * sample.gyro_rad_s.x();
    accel += sample.accel_m_s2.y() * sample.accel_m_s2.y();
  }
  EXPECT_NEAR(std::sqrt(gyro / 20000.0), nav::DegToRad(0.1), 0.03 * nav::DegToRad(0.1));
  EXPECT_NEAR(std::sqrt(accel / 20000.0), 1e-3 * kGravity_m_s2, 0.03e-3 * kGravity_m_s2);
  const nav::ImuCalibration nominal = NominalImu(options);
  EXPECT_DOUBLE_EQ(nominal.gyro_noise_rad_s_sqrt_hz, nav::DegToRad(0.01));
  EXPECT_DOUBLE_EQ(nominal.accel_noise_m_s2_sqrt_hz, 1e-4 * kGravity_m_s2);
}

// Over 300 units, three axes each: a deviation to 2.4 percent; tolerance four of these.
TEST(Imu, BiasesDifferFromTurnOnToTurnOn) {
  ImuOptions options = Perfect();
  options.gyro_bias_sigma_deg_s = 0.1;
  options.accel_bias_sigma_mg = 3.0;
  double gyro = 0.0;
  double accel = 0.0;
  for (std::uint64_t trial = 0; trial < 300; ++trial) {
    const nav::ImuSample sample = Imu(options, 1, trial).Sample(AtRest(0), AtRest(kStep), 0);
    gyro += sample.gyro_rad_s.squaredNorm() / 900.0;
    accel += (sample.accel_m_s2 - Eigen::Vector3d(0.0, 0.0, kGravity_m_s2)).squaredNorm() / 900.0;
  }
  EXPECT_NEAR(nav::RadToDeg(std::sqrt(gyro)), 0.1, 0.01);
  EXPECT_NEAR(std::sqrt(accel) / kGravity_m_s2, 3.0e-3, 0.3e-3);
}

// A walk of 0.01 deg/s per root second reaches 0.01 sqrt(4) after four; as above.
TEST(Imu, TheBiasWalksWithTheRootOfTime) {
  ImuOptions options = Perfect();
  options.gyro_bias_walk_deg_s_sqrt_s = 0.01;
  double square = 0.0;
  for (std::uint64_t trial = 0; trial < 300; ++trial) {
    const nav::ImuSample sample =
        Imu(options, 1, trial).Sample(AtRest(399 * kStep), AtRest(400 * kStep), 399);
    square += sample.gyro_rad_s.squaredNorm() / 900.0;
  }
  EXPECT_NEAR(nav::RadToDeg(std::sqrt(square)), 0.02, 0.002);
}

TEST(Imu, ASkippedSampleChangesNoOther) {
  Imu all({}, 1, 0);
  Imu last({}, 1, 0);
  nav::ImuSample sample;
  for (nav::TimeNs k = 0; k < 50; ++k) {
    sample =
        all.Sample(Tumbling(k * kStep), Tumbling((k + 1) * kStep), static_cast<std::uint64_t>(k));
  }
  const nav::ImuSample same = last.Sample(Tumbling(49 * kStep), Tumbling(50 * kStep), 49);
  EXPECT_EQ(sample.gyro_rad_s, same.gyro_rad_s);
  EXPECT_EQ(sample.accel_m_s2, same.accel_m_s2);
}

TEST(Imu, StopsAtItsRangeAndStepsByItsResolution) {
  ImuOptions options = Perfect();
  options.gyro_range_deg_s = 100.0;
  options.accel_resolution_mg = 50.0;
  Imu imu(options, 1, 0);
  Truth end = AtRest(kStep, RotationOf({0.0, 0.0, nav::DegToRad(5.0)}));
  end.v_WB_m_s = {0.01, 0.0, 0.0};
  const nav::ImuSample sample = imu.Sample(AtRest(0), end, 0);
  EXPECT_DOUBLE_EQ(sample.gyro_rad_s.z(), nav::DegToRad(100.0));
  const double steps = sample.accel_m_s2.x() / (0.05 * kGravity_m_s2);
  EXPECT_NEAR(steps, 2.0, 1e-12);  // 1 m/s^2 is 2.04 steps
}

TEST(Imu, RefusesAnEmptyIntervalAndATurnedBackIndex) {
  Imu imu({}, 1, 0);
  EXPECT_THROW(static_cast<void>(imu.Sample(AtRest(kStep), AtRest(kStep), 0)), std::logic_error);
  static_cast<void>(imu.Sample(AtRest(0), AtRest(kStep), 3));
  EXPECT_THROW(static_cast<void>(imu.Sample(AtRest(0), AtRest(kStep), 3)), std::logic_error);
}

TEST(RotationVector, UndoesRotationOf) {
  for (const Eigen::Vector3d& v :
       {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(1e-9, -2e-9, 0.0),
        Eigen::Vector3d(0.3, -2.0, 1.0), Eigen::Vector3d(0.0, 3.14, 0.0)}) {
    EXPECT_LT((RotationVector(RotationOf(v)) - v).norm(), 1e-14);
    const Eigen::Quaterniond q = RotationOf(v);
    const Eigen::Quaterniond negative(-q.w(), -q.x(), -q.y(), -q.z());
    EXPECT_LT((RotationVector(negative) - v).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace polnav::sim
