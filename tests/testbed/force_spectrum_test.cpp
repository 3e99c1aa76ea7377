// What is known to shake an accelerometer is seen in its spectrum.
#include "tools/testbed/force_spectrum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace polnav::testbed {
namespace {

constexpr double kRate_hz = 100.0;
constexpr std::size_t kStretch = 1024;  // the power of two nearest to ten seconds
constexpr double kBin_hz = kRate_hz / kStretch;

nav::ImuSample SampleAt(nav::TimeNs k, const Eigen::Vector3d& force) {
  return {.stamp = k * 10'000'000, .accel_m_s2 = force};
}

// Of a sine ahead that falls on a line of the spectrum, and one up that falls on another.
Eigen::Vector3d Shaken(nav::TimeNs k, double ahead_hz, double up_hz) {
  const double t_s = static_cast<double>(k) / kRate_hz;
  return {0.3 * std::sin(2.0 * std::numbers::pi * ahead_hz * t_s), 0.0,
          9.81 + 0.7 * std::cos(2.0 * std::numbers::pi * up_hz * t_s)};
}

ForceLines LinesOf(const nav::ImuCalibration& imu, nav::TimeNs samples) {
  ForceSpectrum spectrum(imu);
  for (nav::TimeNs k = 1; k <= samples; ++k) {
    spectrum.Add(SampleAt(k, Shaken(k, 26 * kBin_hz, 13 * kBin_hz)));
  }
  return spectrum.Lines().value();
}

// The fade spreads a line over its two neighbours, at half its height, and no further.
TEST(ForceSpectrum, ASineReadsItsAmplitude) {
  const ForceLines lines = LinesOf({.rate_hz = kRate_hz}, 5000);
  ASSERT_EQ(lines.up_m_s2.size(), kStretch / 2 + 1);
  EXPECT_DOUBLE_EQ(lines.step_hz, kBin_hz);
  EXPECT_NEAR(lines.up_m_s2[13], 0.7, 1e-9);
  EXPECT_NEAR(lines.up_m_s2[14], 0.35, 1e-9);
  EXPECT_NEAR(lines.up_m_s2[15], 0.0, 1e-9);
  EXPECT_NEAR(lines.up_m_s2[0], 0.0, 1e-9) << "gravity is the mean, and taken away";
  EXPECT_NEAR(lines.ahead_m_s2[26], 0.3, 1e-9);
  EXPECT_NEAR(lines.ahead_m_s2[13], 0.0, 1e-9);
}

// Mounted with its x axis up.
TEST(ForceSpectrum, IsInTheBodysAxes) {
  nav::ImuCalibration imu{.rate_hz = kRate_hz};
  imu.T_BI.q = Eigen::AngleAxisd(-0.5 * std::numbers::pi, Eigen::Vector3d::UnitY());
  ForceSpectrum spectrum(imu);
  for (nav::TimeNs k = 1; k <= 2000; ++k) {
    spectrum.Add(SampleAt(k, imu.T_BI.q.conjugate() * Shaken(k, 26 * kBin_hz, 13 * kBin_hz)));
  }
  EXPECT_NEAR(spectrum.Lines()->up_m_s2[13], 0.7, 1e-9);
  EXPECT_NEAR(spectrum.Lines()->ahead_m_s2[26], 0.3, 1e-9);
}

// No stretch reaches over a gap or a reading that is no number: a step of a kilogravity amid them
// would show in every line.
TEST(ForceSpectrum, GapsAndNonsenseBeginAnew) {
  ForceSpectrum spectrum({.rate_hz = kRate_hz});
  EXPECT_FALSE(spectrum.Lines().has_value());
  for (nav::TimeNs k = 1; k < 1000; ++k) spectrum.Add(SampleAt(k, {1e3, 0.0, 1e3}));
  spectrum.Add(SampleAt(1000, {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}));
  for (nav::TimeNs k = 1001; k < 2000; ++k) spectrum.Add(SampleAt(k, {1e3, 0.0, 1e3}));
  EXPECT_FALSE(spectrum.Lines().has_value());
  for (nav::TimeNs k = 2002; k < 4000; ++k) {
    spectrum.Add(SampleAt(k, Shaken(k, 26 * kBin_hz, 13 * kBin_hz)));
  }
  ASSERT_TRUE(spectrum.Lines().has_value());
  EXPECT_NEAR(spectrum.Lines()->up_m_s2[13], 0.7, 1e-9);
  EXPECT_NEAR(spectrum.Lines()->up_m_s2[20], 0.0, 1e-9);
}

}  // namespace
}  // namespace polnav::testbed
