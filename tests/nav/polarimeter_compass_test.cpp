#include "nav/polarization/polarimeter_compass.h"

#include <gtest/gtest.h>

#include <cmath>

#include "nav/polarization/sky_heading.h"

namespace polnav::nav {
namespace {

// Sun 10 degrees high in the south-west, as in Chu2021's experiment A.
Eigen::Vector3d Sun(TimeNs) {
  const double azimuth = DegToRad(232.7);
  const double elevation = DegToRad(10.0);
  return {std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation),
          std::sin(elevation)};
}

// Of a level sensor below a Rayleigh zenith: the E-vector lies across the sun's direction.
PolarizationSample Reading(TimeNs stamp, double heading_rad, double dop) {
  const Eigen::Vector3d e_W = Sun(stamp).cross(Eigen::Vector3d::UnitZ()).normalized();
  const Eigen::Vector3d e_B = LevelAttitude(heading_rad).conjugate() * e_W;
  const double phi = std::atan2(e_B.y(), e_B.x());
  PolarizationSample sample{.stamp = stamp};
  constexpr std::array<double, 6> kAngles_deg = {0, 90, 60, 150, 120, 210};
  for (std::size_t i = 0; i < 6; ++i) {
    sample.channel[i] = 1.0 + dop * std::cos(2.0 * phi - 2.0 * DegToRad(kAngles_deg[i]));
  }
  return sample;
}

PolarimeterCompass Compass(double start_rad) {
  return {PolarizationOptions{}, PolarimeterCalibration{}, Sun,
          StartPrior{.heading_rad = start_rad}};
}

TEST(PolarimeterCompass, FollowsAWholeTurnFromACoarseStart) {
  PolarimeterCompass compass = Compass(DegToRad(40.0));
  for (int i = 0; i <= 360; ++i) {
    const double heading = DegToRad(i);
    const Report report = compass.Process(Reading(i * 1'000'000, heading, 0.5));
    ASSERT_TRUE(report.estimate);
    EXPECT_NEAR(WrapPi(CompassHeading(report.estimate->T_WB.q) - heading), 0.0, 1e-9);
  }
}

TEST(PolarimeterCompass, StaysHalfATurnOffWhereItWasStartedSo) {
  const Report report = Compass(DegToRad(170.0)).Process(Reading(0, 0.0, 0.5));
  EXPECT_NEAR(std::abs(CompassHeading(report.estimate->T_WB.q)), DegToRad(180.0), 1e-9);
}

TEST(PolarimeterCompass, GivesNoHeadingOfUnpolarizedLightOrADeadChannelOrTheSameOnceMore) {
  PolarimeterCompass compass = Compass(0.0);
  EXPECT_EQ(compass.Process(Reading(0, 0.0, 0.05)).outcome, Outcome::kUnusable);
  PolarizationSample dead = Reading(1, 0.0, 0.5);
  dead.channel[2] = 0.0;
  EXPECT_EQ(compass.Process(dead).outcome, Outcome::kUnusable);
  EXPECT_EQ(compass.Process(Reading(2, 0.0, 0.5)).outcome, Outcome::kUsed);
  EXPECT_EQ(compass.Process(Reading(2, 0.0, 0.5)).outcome, Outcome::kUnusable);
}

}  // namespace
}  // namespace polnav::nav
