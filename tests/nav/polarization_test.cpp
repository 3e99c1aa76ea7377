#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "nav/polarization/heading_fusion.h"
#include "nav/polarization/six_channel.h"
#include "nav/polarization/sky_heading.h"
#include "nav/stereo/reprojection.h"

namespace polnav::nav {
namespace {

const Eigen::Matrix3d kSure = 1e-6 * Eigen::Matrix3d::Identity();  // [rad^2]

// [Zeng2020, eq. 2] with its factor 2 mended.
PolarizationSample Channels(double intensity, double dop, double phi) {
  constexpr std::array<double, 6> kAnglesDeg = {0, 90, 60, 150, 120, 210};
  PolarizationSample sample;
  for (std::size_t i = 0; i < 6; ++i) {
    sample.channel[i] =
        intensity * (1.0 + dop * std::cos(2.0 * phi - 2.0 * DegToRad(kAnglesDeg[i])));
  }
  return sample;
}

TEST(SixChannel, InvertsTheForwardModelForEveryAngle) {
  for (double phi = -1.5; phi < 1.6; phi += 0.05) {
    const auto light = DecodeSixChannels(Channels(0.3, 0.45, phi));
    ASSERT_TRUE(light);
    EXPECT_NEAR(light->dop, 0.45, 1e-12);
    EXPECT_NEAR(WrapHalfPi(light->axis_rad - phi), 0.0, 1e-12);
    EXPECT_NEAR(light->pair_sum, 0.0, 1e-12);
  }
}

TEST(SixChannel, ADeadChannelShowsInThePairSum) {
  PolarizationSample sample = Channels(0.3, 0.45, 0.2);
  sample.channel[2] = 0.0;
  const auto light = DecodeSixChannels(sample);
  ASSERT_TRUE(light);
  EXPECT_GT(std::abs(light->pair_sum), 0.3);
}

// White noise of standard deviation s on every opponent output: the angle is half that of a vector
// of length 3 d whose components, 2 p1 - p2 - p3 and sqrt(3) (p2 - p3), each carry sqrt(6) s. So
// sigma = s / (sqrt(6) d), and with s = sigma_I / (sqrt(2) I) of two channels for small d, sigma_I
// / I over sqrt(12) d. 200,000 readings know a deviation to 0.16 %; d^2 / 4 and the noise's own
// size stay below 1 %.
TEST(SixChannel, SigmaOfTheAngleIsAsTheorySays) {
  std::mt19937_64 engine(5);
  std::normal_distribution<double> gaussian;
  constexpr double kNoise = 0.002;
  for (const double dop : {0.1, 0.2}) {
    double square = 0.0;
    constexpr int kReadings = 200000;
    for (int i = 0; i < kReadings; ++i) {
      const double phi = 3.0 * i / kReadings;
      PolarizationSample sample = Channels(1.0, dop, phi);
      for (double& channel : sample.channel) channel += kNoise * gaussian(engine);
      square += std::pow(WrapHalfPi(DecodeSixChannels(sample)->axis_rad - phi), 2);
    }
    const double expected = kNoise / (std::sqrt(12.0) * dop);
    EXPECT_NEAR(std::sqrt(square / kReadings), expected, 0.02 * expected) << dop;
  }
}

TEST(SixChannel, DarknessIsNoAnswer) { EXPECT_FALSE(DecodeSixChannels(Channels(0.0, 0.5, 0.2))); }

Eigen::Vector3d Sun(double azimuth, double elevation) {
  return {std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth),
          std::sin(elevation)};
}

// E-vector of a Rayleigh sky along the body's z axis, in B.
Eigen::Vector3d ZenithEVector(const Eigen::Quaterniond& q_WB, const Eigen::Vector3d& sun_W) {
  return q_WB.conjugate() * sun_W.cross(q_WB * Eigen::Vector3d::UnitZ()).normalized();
}

TEST(SkyHeading, IsExactForEveryHeadingSunAzimuthAndTilt) {
  const Eigen::Vector3d tilt(0.03, -0.05, 0.0);
  for (double azimuth = 0.0; azimuth < 6.2; azimuth += 0.31) {
    const Eigen::Vector3d sun = Sun(azimuth, 0.29);
    for (double heading = -3.1; heading < 3.2; heading += 0.31) {
      const Eigen::Quaterniond truth = LevelAttitude(heading) * ExpRotation(tilt);
      // The guess is off by 0.5 rad in heading, with the right pitch and roll.
      const Eigen::Quaterniond guess = ExpRotation({0.0, 0.0, 0.5}) * truth;
      const auto found = HeadingFromEVector(ZenithEVector(truth, sun), guess, sun);
      ASSERT_TRUE(found);
      EXPECT_NEAR(WrapPi(*found - CompassHeading(truth)), 0.0, 1e-9);
    }
  }
}

// [Chu2021, eq. 8] psi = alpha + f_s + pi/2 with alpha counted clockwise as headings are.
TEST(SkyHeading, AgreesWithChu2021WhenLevel) {
  const double sun_azimuth = DegToRad(230.09);
  const Eigen::Vector3d sun = Sun(sun_azimuth, DegToRad(16.5));
  const double heading = DegToRad(77.0);
  const Eigen::Vector3d e_B = ZenithEVector(LevelAttitude(heading), sun);
  const double alpha_left = std::atan2(e_B.y(), e_B.x());  // counter-clockwise from body x
  EXPECT_NEAR(WrapHalfPi(alpha_left + sun_azimuth + 0.5 * M_PI - heading), 0.0, 1e-12);
}

TEST(SkyHeading, TheSignOfTheEVectorMeansNothing) {
  const Eigen::Vector3d sun = Sun(1.0, 0.3);
  const Eigen::Quaterniond q = LevelAttitude(2.0) * ExpRotation({0.02, 0.04, 0.0});
  const Eigen::Vector3d e = ZenithEVector(q, sun);
  EXPECT_NEAR(*HeadingFromEVector(e, q, sun), *HeadingFromEVector(-e, q, sun), 1e-12);
}

TEST(SkyHeading, ByTiltIsTheDerivative) {
  const Eigen::Vector3d sun = Sun(1.0, 0.5);
  const Eigen::Quaterniond q = LevelAttitude(2.0) * ExpRotation({0.02, 0.04, 0.0});
  const Eigen::Vector3d e_B = ZenithEVector(q, sun);
  const Eigen::Vector2d by_tilt = HeadingByTilt(q * e_B, sun);
  constexpr double kStep = 1e-6;
  for (int k = 0; k < 2; ++k) {
    // The heading answered for a tilted attitude, less what the tilt itself does to the compass
    // heading of the body's axis: only a turn about the vertical counts as one.
    const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(k);
    const auto turn_for = [&](const Eigen::Quaterniond& tilted) {
      return *HeadingFromEVector(e_B, tilted, sun) - CompassHeading(tilted);
    };
    const double difference =
        (turn_for(ExpRotation(d) * q) - turn_for(ExpRotation(-d) * q)) / (2.0 * kStep);
    EXPECT_NEAR(difference, by_tilt(k), 1e-7) << k;
  }
}

// Readings every 50 ms of a standing vehicle whose heading vision believes to be off by 0.01 rad.
TEST(HeadingFusion, AveragesReadingsAndStatesTheirVariance) {
  const Eigen::Vector3d sun = Sun(2.0, 0.3);
  PolarizationOptions options{.reading_sigma_deg = 1.0, .correlated_sigma_deg = 0.0};
  HeadingFusion fusion(options, {}, [&](TimeNs) { return sun; });
  const Eigen::Quaterniond truth = LevelAttitude(0.7);
  const Eigen::Quaterniond believed = LevelAttitude(0.71);
  const Eigen::Vector3d e = ZenithEVector(truth, sun);
  for (int i = 1; i <= 20; ++i) {
    // Never twice the same to the last bit.
    PolarizationSample sample = Channels(0.3 + 1e-6 * i, 0.5, std::atan2(e.y(), e.x()));
    sample.stamp = i * kNsPerSecond / 20;
    EXPECT_EQ(fusion.Add(sample), Outcome::kUsed);
  }
  EXPECT_EQ(fusion.Advance(0, believed, kNsPerSecond, believed, 0.01 * Eigen::Matrix3d::Identity()),
            0);
  ASSERT_EQ(fusion.residuals().size(), 20U);
  for (const SkyResidual& r : fusion.residuals()) {
    EXPECT_NEAR(r.residual_rad, -0.01, 1e-9);
    EXPECT_GT(r.sigma_rad, std::hypot(DegToRad(1.0), 0.1) - 1e-12);  // the reading's and vision's
    EXPECT_FALSE(r.gated);
  }
  const auto edge = fusion.TakeEdge(kNsPerSecond, believed, kSure);
  ASSERT_TRUE(edge);
  EXPECT_NEAR(edge->heading_rad, 0.7, 1e-9);
  EXPECT_NEAR(edge->sigma_rad, DegToRad(1.0) / std::sqrt(20.0), 1e-12);
  EXPECT_FALSE(fusion.TakeEdge(kNsPerSecond, believed, kSure)) << "no reading is used twice";
}

TEST(HeadingFusion, AReadingFarFromVisionIsGated) {
  const Eigen::Vector3d sun = Sun(2.0, 0.3);
  HeadingFusion fusion({}, {}, [&](TimeNs) { return sun; });
  const Eigen::Vector3d e = ZenithEVector(LevelAttitude(0.7), sun);
  ASSERT_EQ(fusion.Add(Channels(0.3, 0.5, std::atan2(e.y(), e.x()))), Outcome::kUsed);
  EXPECT_EQ(fusion.Advance(0, LevelAttitude(1.2), 0, LevelAttitude(1.2), kSure), 1);
  EXPECT_FALSE(fusion.TakeEdge(0, LevelAttitude(1.2), kSure));
}

// Clear is half of 0.7 times Rayleigh's at 60 degrees from the sun: 0.8 * 0.7 * 0.6 = 0.336.
TEST(HeadingFusion, LightFromElsewhereCountsForLess) {
  const Eigen::Vector3d sun = Sun(2.0, DegToRad(30.0));
  const Eigen::Quaterniond q = LevelAttitude(0.7);
  const Eigen::Vector3d e = ZenithEVector(q, sun);
  const auto sigma = [&](double dop) {
    HeadingFusion fusion({.reading_sigma_deg = 0.01, .correlated_sigma_deg = 0.3}, {},
                         [&](TimeNs) { return sun; });
    for (int i = 1; i <= 20; ++i) {
      PolarizationSample sample = Channels(0.3 + 1e-6 * i, dop, std::atan2(e.y(), e.x()));
      sample.stamp = i;
      (void)fusion.Add(sample);
    }
    (void)fusion.Advance(0, q, 20, q, kSure);
    return RadToDeg(fusion.TakeEdge(20, q, kSure)->sigma_rad);
  };
  EXPECT_NEAR(sigma(0.4), 0.3, 0.01);
  EXPECT_NEAR(sigma(0.168), std::hypot(0.3, 2.0), 0.01);  // half of it from elsewhere
}

TEST(HeadingFusion, AFrozenDriverIsNoSky) {
  HeadingFusion fusion({}, {}, [](TimeNs) { return Eigen::Vector3d::UnitX(); });
  PolarizationSample sample = Channels(0.3, 0.5, 0.4);
  sample.stamp = 10;
  EXPECT_EQ(fusion.Add(sample), Outcome::kUsed);
  sample.stamp = 20;
  EXPECT_EQ(fusion.Add(sample), Outcome::kUnusable);
}

TEST(HeadingFusion, TakesNoReadingTwiceOrLate) {
  HeadingFusion fusion({}, {}, [](TimeNs) { return Eigen::Vector3d::UnitX(); });
  PolarizationSample sample = Channels(0.3, 0.5, 0.4);
  sample.stamp = 10;
  EXPECT_EQ(fusion.Add(sample), Outcome::kUsed);
  EXPECT_EQ(fusion.Add(sample), Outcome::kUnusable);
  (void)fusion.Advance(0, LevelAttitude(0.0), 20, LevelAttitude(0.0), kSure);
  sample.stamp = 15;
  sample.channel[0] += 1e-6;
  EXPECT_EQ(fusion.Add(sample), Outcome::kUnusable);
  sample.stamp = 25;
  sample.channel[0] += 1e-6;
  EXPECT_EQ(fusion.Add(sample), Outcome::kUsed);
}

TEST(HeadingFusion, UnpolarizedLightIsUnusable) {
  HeadingFusion fusion({}, {}, [](TimeNs) { return Eigen::Vector3d::UnitX(); });
  EXPECT_EQ(fusion.Add(Channels(0.3, 0.02, 0.4)), Outcome::kUnusable);
}

}  // namespace
}  // namespace polnav::nav
