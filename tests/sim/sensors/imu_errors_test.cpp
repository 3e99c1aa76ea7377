// The errors that make an IMU a particular one: bias by hand, force on gyroscopes, warmth, presets.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "sim/sensors/imu.h"
#include "sim/sensors/rotation.h"

namespace polnav::sim {
namespace {

constexpr nav::TimeNs kStep = 10'000'000;  // 100 Hz
constexpr double kMilliG_m_s2 = 1e-3 * kGravity_m_s2;

nav::ImuSample AtRest(const ImuOptions& options, std::uint64_t trial = 0,
                      const Eigen::Quaterniond& q_WB = Eigen::Quaterniond::Identity(),
                      nav::TimeNs stamp = kStep) {
  Truth begin;
  begin.T_WB.q = q_WB;
  begin.stamp = stamp - kStep;
  Truth end = begin;
  end.stamp = stamp;
  return Imu(options, 1, trial).Sample(begin, end, 0);
}

// What a unit without noise, scale and leaning axes reads at rest beyond gravity: from turn-on,
// warming and wandering, whichever way it goes.
TEST(ImuErrors, TheBiasIsWhatARestingUnitReads) {
  ImuOptions options = ImuPreset("icm20602");
  options.gyro_noise_deg_s_sqrt_hz = options.accel_noise_mg_sqrt_hz = 0.0;
  options.gyro_scale_sigma = options.accel_scale_sigma = options.misalignment_sigma_deg = 0.0;
  options.gyro_temperature_scale_1_k = options.accel_temperature_scale_1_k = 0.0;
  options.gyro_resolution_deg_s = options.accel_resolution_mg = 0.0;
  options.gyro_g_sensitivity_deg_s_g = 0.0;
  options.gyro_bias_walk_deg_s_sqrt_s = 0.1;
  options.temperature = {.start_deg_c = 25.0, .end_deg_c = 45.0, .time_constant_s = 100.0};
  Imu imu(options, 1, 0);
  const Eigen::Vector3d from_turn_on = imu.Bias(0).gyro_rad_s;
  for (nav::TimeNs k = 1; k <= 1000; ++k) {
    const nav::ImuSample sample = imu.Sample({.stamp = (k - 1) * kStep}, {.stamp = k * kStep},
                                             static_cast<std::uint64_t>(k - 1));
    const ImuBias bias = imu.Bias(k * kStep);
    ASSERT_LT((sample.gyro_rad_s - bias.gyro_rad_s).norm(), 1e-15) << k;
    ASSERT_LT((sample.accel_m_s2 - bias.accel_m_s2 - Eigen::Vector3d(0, 0, kGravity_m_s2)).norm(),
              1e-13)
        << k;
  }
  EXPECT_GT((imu.Bias(1000 * kStep).gyro_rad_s - from_turn_on).norm(), nav::DegToRad(0.05))
      << "ten seconds' walk has a sigma of 0.3 deg/s an axis";
}

// The hexapod of [Zeng2020]: ICM-20602, gyroscopes off by 1 deg/s, accelerometers by 40 mg.
TEST(ImuErrors, ABiasCanBeGivenByHand) {
  ImuOptions options = ImuPreset("perfect");
  options.gyro_bias_deg_s = {1.0, -1.0, 1.0};
  options.accel_bias_mg = {40.0, 40.0, -40.0};
  const nav::ImuSample sample = AtRest(options);
  EXPECT_LT((sample.gyro_rad_s - nav::DegToRad(1.0) * Eigen::Vector3d(1.0, -1.0, 1.0)).norm(),
            1e-15);
  EXPECT_LT((sample.accel_m_s2 - kMilliG_m_s2 * Eigen::Vector3d(40.0, 40.0, 960.0)).norm(), 1e-13);
}

// Deviations over 300 units, nine elements each: to 1.4 percent; tolerance four of these.
TEST(ImuErrors, ForceAlongAnyAxisFakesARate) {
  ImuOptions options = ImuPreset("perfect");
  options.gyro_g_sensitivity_deg_s_g = 0.1;
  double square = 0.0;
  for (std::uint64_t trial = 0; trial < 300; ++trial) {
    for (const Eigen::Vector3d& turn :
         {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(0.5 * M_PI, 0.0, 0.0),
          Eigen::Vector3d(0.0, 0.5 * M_PI, 0.0)}) {
      square += AtRest(options, trial, RotationOf(turn)).gyro_rad_s.squaredNorm() / 2700.0;
    }
  }
  EXPECT_NEAR(nav::RadToDeg(std::sqrt(square)), 0.1, 0.0056);
  // The same unit upside down errs the other way round.
  const Eigen::Vector3d up = AtRest(options).gyro_rad_s;
  const Eigen::Vector3d down = AtRest(options, 0, RotationOf({M_PI, 0.0, 0.0})).gyro_rad_s;
  EXPECT_LT((up + down).norm(), 1e-15);
}

// From 25 to 45 degrees with 100 s: after 100 s 20 (1 - 1/e) kelvins above calibration.
TEST(ImuErrors, ABiasGrowsWithTheTemperature) {
  ImuOptions options = ImuPreset("perfect");
  options.gyro_temperature_bias_deg_s_k = 0.01;
  options.accel_temperature_bias_mg_k = 0.5;
  options.temperature = {.start_deg_c = 25.0, .end_deg_c = 45.0, .time_constant_s = 100.0};
  const double warmer_k = 20.0 * (1.0 - std::exp(-1.0));
  double gyro = 0.0;
  double accel = 0.0;
  for (std::uint64_t trial = 0; trial < 300; ++trial) {
    const nav::ImuSample sample =
        AtRest(options, trial, Eigen::Quaterniond::Identity(), 100 * 100 * kStep);
    gyro += sample.gyro_rad_s.squaredNorm() / 900.0;
    accel += (sample.accel_m_s2 - Eigen::Vector3d(0.0, 0.0, kGravity_m_s2)).squaredNorm() / 900.0;
  }
  EXPECT_NEAR(nav::RadToDeg(std::sqrt(gyro)) / warmer_k, 0.01, 0.001);
  EXPECT_NEAR(std::sqrt(accel) / kMilliG_m_s2 / warmer_k, 0.5, 0.05);
}

TEST(ImuErrors, ScaleGrowsWithTheTemperatureAndTheTruth) {
  ImuOptions options = ImuPreset("perfect");
  options.accel_temperature_scale_1_k = 1e-4;
  options.temperature = {.start_deg_c = 65.0, .end_deg_c = 65.0};
  double square = 0.0;
  for (std::uint64_t trial = 0; trial < 600; ++trial) {
    const Eigen::Vector3d error =
        AtRest(options, trial).accel_m_s2 - Eigen::Vector3d(0.0, 0.0, kGravity_m_s2);
    EXPECT_EQ(error.head<2>().norm(), 0.0) << "nothing to scale";
    square += error.z() * error.z() / 600.0;
  }
  EXPECT_NEAR(std::sqrt(square) / kGravity_m_s2 / 40.0, 1e-4, 0.12e-4);
}

// A turn about z at 2 rad/s, growing by 3 rad/s^2: a point 0.5 m ahead feels -w^2 r along x and the
// angular acceleration times r along y. Readings are means: 1e-3 is the change over 10 ms and more.
TEST(ImuErrors, ALeverArmFeelsTheTurn) {
  ImuOptions options = ImuPreset("perfect");
  options.position_m = {0.5, 0.0, 0.0};
  const auto turning = [](double t_s) {
    Truth truth;
    truth.stamp = nav::FromSeconds(t_s);
    truth.T_WB.q = RotationOf({0.0, 0.0, 2.0 * t_s + 1.5 * t_s * t_s});
    truth.w_WB_B_rad_s = {0.0, 0.0, 2.0 + 3.0 * t_s};
    return truth;
  };
  const nav::ImuSample sample = Imu(options, 1, 0).Sample(turning(0.0), turning(1e-4), 0);
  EXPECT_NEAR(sample.accel_m_s2.x(), -2.0 * 2.0 * 0.5, 1e-3);
  EXPECT_NEAR(sample.accel_m_s2.y(), 3.0 * 0.5, 1e-3);
  EXPECT_NEAR(sample.accel_m_s2.z(), kGravity_m_s2, 1e-12);
}

// What one source draws is nobody else's: with another at zero, the rest is the same.
TEST(ImuErrors, ASourceLeavesTheOthersAsTheyAre) {
  ImuOptions with = ImuPreset("icm20602");
  with.gyro_resolution_deg_s = with.accel_resolution_mg = 0.0;
  with.temperature.start_deg_c = 60.0;
  ImuOptions without = with;
  without.gyro_bias_instability_deg_h = 0.0;
  without.gyro_g_sensitivity_deg_s_g = 0.0;
  without.gyro_temperature_bias_deg_s_k = without.gyro_temperature_scale_1_k = 0.0;
  ImuOptions only = ImuPreset("perfect");
  only.gyro_bias_instability_deg_h = with.gyro_bias_instability_deg_h;
  only.gyro_g_sensitivity_deg_s_g = with.gyro_g_sensitivity_deg_s_g;
  only.gyro_temperature_bias_deg_s_k = with.gyro_temperature_bias_deg_s_k;
  only.gyro_temperature_scale_1_k = with.gyro_temperature_scale_1_k;
  only.temperature = with.temperature;
  const Eigen::Vector3d force(0.0, 0.0, kGravity_m_s2);
  const nav::ImuSample a = AtRest(with);
  const nav::ImuSample b = AtRest(without);
  const nav::ImuSample c = AtRest(only);
  EXPECT_LT((a.gyro_rad_s - b.gyro_rad_s - c.gyro_rad_s).norm(), 1e-14);
  EXPECT_LT((a.accel_m_s2 - b.accel_m_s2 - (c.accel_m_s2 - force)).norm(), 1e-14);
}

TEST(ImuErrors, AnEstimatorIsToldTheDataSheet) {
  ImuOptions options = ImuPreset("hg4930");
  options.position_m = {1.0, 2.0, 3.0};
  options.gyro_bias_deg_s = {5.0, 5.0, 5.0};
  const nav::ImuCalibration nominal = NominalImu(options);
  EXPECT_EQ(nominal.T_BI.p, options.position_m);
  EXPECT_DOUBLE_EQ(nominal.gyro_bias_instability_rad_s, nav::DegToRad(0.25) / 3600.0);
  EXPECT_DOUBLE_EQ(nominal.accel_bias_instability_m_s2, 0.025 * kMilliG_m_s2);
  EXPECT_DOUBLE_EQ(nominal.gyro_bias_walk_rad_s_sqrt_s, nav::DegToRad(3.8e-7));
  EXPECT_DOUBLE_EQ(nominal.gyro_bias_sigma_rad_s, nav::DegToRad(7.0 / 3600.0));
}

TEST(ImuErrors, APresetKnowsItsName) {
  EXPECT_EQ(ImuPreset("span_cpt").preset, "span_cpt");
  EXPECT_EQ(ImuPreset("adis16475_2").gyro_noise_deg_s_sqrt_hz,
            ImuOptions{}.gyro_noise_deg_s_sqrt_hz);
  EXPECT_THROW(static_cast<void>(ImuPreset("icm20601")), std::logic_error);
}

}  // namespace
}  // namespace polnav::sim
