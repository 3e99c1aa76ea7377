#include "sky/polarimeter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "sky/sun.h"

namespace polnav::sky {
namespace {

using std::numbers::pi;

constexpr double kDegree = pi / 180.0;
const Eigen::Vector3d kOrigin = Eigen::Vector3d::Zero();

struct Decoded {
  double d, phi, opponent_sum;
};

// [Zeng2020, eqs 4-8], written from the paper.
Decoded Decode(const SixChannels& c) {
  const double p1 = (c[0] - c[1]) / (c[0] + c[1]);
  const double p2 = (c[2] - c[3]) / (c[2] + c[3]);
  const double p3 = (c[4] - c[5]) / (c[4] + c[5]);
  const double d = 2.0 / 3.0 * std::sqrt(p1 * p1 + p2 * p2 + p3 * p3 - p1 * p2 - p2 * p3 - p1 * p3);
  const double phi = 0.5 * std::atan2(std::sqrt(3.0) * (p2 - p3), 2.0 * p1 - p2 - p3);
  return {d, phi, p1 + p2 + p3};
}

Eigen::Quaterniond Turned(double angle) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
}

WorldSky ClearSky(double cover = 0.0) {
  SkyOptions options;
  options.thin_cloud_cover = cover;
  return {options, DirectionEnu(230.0 * kDegree, 16.5 * kDegree), 11};
}

// Looking at the zenith, x at compass azimuth a: the E-vector is across the sun's azimuth, so
// phi = a - sun - 90 degrees counted against the compass, from x towards y.
TEST(ReadSixChannels, IdealOpticsGiveBackTheAngleAtEveryHeading) {
  const WorldSky sky = ClearSky();
  for (double heading = -pi; heading < pi; heading += 0.1) {
    const Eigen::Quaterniond q_WS = Turned(0.5 * pi - heading);
    const Decoded out = Decode(ReadSixChannels({}, q_WS, kOrigin, 0.0, sky));
    EXPECT_NEAR(std::remainder(out.phi - (heading - 230.0 * kDegree - 0.5 * pi), pi), 0.0, 1e-13);
  }
}

TEST(ReadSixChannels, IdealOpticsGiveBackDegreeAndAngleOfATiltedCone) {
  const WorldSky sky = ClearSky(0.3);
  for (double tilt = 0.0; tilt < 0.6; tilt += 0.1) {
    const Eigen::Quaterniond q_WS =
        Eigen::AngleAxisd(tilt, Eigen::Vector3d(0.6, 0.8, 0.0)) * Turned(0.3);
    const SixChannelOptics optics;
    const ConeLight light = AverageOverCone(optics.fov_rad, q_WS, kOrigin, 4.0, sky);
    const SixChannels channels = ReadSixChannels(optics, q_WS, kOrigin, 4.0, sky);
    const Decoded out = Decode(channels);
    EXPECT_NEAR(out.d, std::hypot(light.q, light.u), 1e-14);
    EXPECT_NEAR(std::remainder(out.phi - 0.5 * std::atan2(light.u, light.q), pi), 0.0, 1e-14);
    EXPECT_NEAR(out.opponent_sum, 0.0, 1e-14);
    EXPECT_NEAR(channels[0] + channels[1], 2.0 * optics.exposure * light.i, 1e-14);
  }
}

// A single ray and the tensor of Look: the same light, whichever axes it is written in.
TEST(AverageOverCone, APointLooksAsTheSky) {
  const WorldSky sky = ClearSky(0.2);
  const Eigen::Vector3d ray = DirectionEnu(2.0, 0.8);
  const Skylight look = sky.Look(ray, kOrigin, 1.0);
  Eigen::Matrix3d R_WS;
  R_WS << look.axis1_W, -look.axis2_W, ray;
  const ConeLight light = AverageOverCone(0.0, Eigen::Quaterniond(R_WS), kOrigin, 1.0, sky);
  EXPECT_NEAR(light.i, look.radiance, 1e-12);
  EXPECT_NEAR(light.q, look.q, 1e-12);
  EXPECT_NEAR(light.u, -look.u, 1e-12);
}

// The integral by brute force: midpoints of 60 x 180 cells of equal solid angle. Its own error goes
// with the square of 1/60 times the variation over the cone's depth, which is 0.06 at 20 degrees
// from the axis: 2e-6 with a factor in hand.
ConeLight BruteForce(double fov_rad, const WorldSky& sky) {
  const Eigen::Quaterniond q_WS = Eigen::Quaterniond::Identity();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int ring = 0; ring < 60; ++ring) {
    const double cosine = 1.0 - (ring + 0.5) / 60.0 * (1.0 - std::cos(0.5 * fov_rad));
    for (int k = 0; k < 180; ++k) {
      const Eigen::Vector3d axis(std::cos(k * 2.0 * kDegree), std::sin(k * 2.0 * kDegree), 0.0);
      const Eigen::Quaterniond q(Eigen::AngleAxisd(std::acos(cosine), axis));
      const ConeLight ray = AverageOverCone(0.0, q_WS * q, kOrigin, 30.0, sky);
      sum += ray.i * Eigen::Vector3d(1.0, ray.q, ray.u);
    }
  }
  return {sum[0] / 10800.0, sum[1] / sum[0], sum[2] / sum[0]};
}

TEST(AverageOverCone, IsTheIntegralOverTheCone) {
  for (const double fov_deg : {10.0, 40.0}) {
    const WorldSky sky = ClearSky();
    const ConeLight exact = BruteForce(fov_deg * kDegree, sky);
    const ConeLight light =
        AverageOverCone(fov_deg * kDegree, Eigen::Quaterniond::Identity(), kOrigin, 30.0, sky);
    EXPECT_NEAR(light.q, exact.q, 2e-6);
    EXPECT_NEAR(light.u, exact.u, 2e-6);
  }
  const WorldSky veiled = ClearSky(0.15);
  const ConeLight exact = BruteForce(10.0 * kDegree, veiled);
  const ConeLight light =
      AverageOverCone(10.0 * kDegree, Eigen::Quaterniond::Identity(), kOrigin, 30.0, veiled);
  EXPECT_NEAR(light.q, exact.q, 2e-4);
  EXPECT_NEAR(light.u, exact.u, 2e-4);
}

// Amplitude of the harmonic n psi in the error of phi over a full turn of the instrument.
double Harmonic(const SixChannelOptics& optics, int n) {
  constexpr int kSteps = 72;
  const WorldSky sky = ClearSky();
  double cosine = 0.0;
  double sine = 0.0;
  for (int k = 0; k < kSteps; ++k) {
    const double psi = 2.0 * pi * k / kSteps;
    const double phi = Decode(ReadSixChannels(optics, Turned(psi), kOrigin, 0.0, sky)).phi;
    const double ideal = Decode(ReadSixChannels({}, Turned(psi), kOrigin, 0.0, sky)).phi;
    const double error = std::remainder(phi - ideal, pi);
    cosine += error * std::cos(n * psi) * 2.0 / kSteps;
    sine += error * std::sin(n * psi) * 2.0 / kSteps;
  }
  return std::hypot(cosine, sine);
}

// With channel 0 too bright by g, p1 grows by g/2 (1 - p1^2). The angle is half that of a vector
// 3 d long of which p1 moves one component by twice as much: dphi = -(g / 6d) sin(2 phi)
// (1 - d^2 cos^2(2 phi)), whose part of period pi is (g / 6d) (1 - d^2 / 4). The square of g, 3
// percent of that, turns with 4 psi. Nothing has an odd period: half a turn shows the same axis.
TEST(ReadSixChannels, AGainErrorTurnsWithTwicePsi) {
  SixChannelOptics optics;
  optics.gain[0] = 1.02;
  const double d = Decode(ReadSixChannels({}, Turned(0.0), kOrigin, 0.0, ClearSky())).d;
  const double expected = 0.02 / (6.0 * d) * (1.0 - 0.25 * d * d);
  EXPECT_NEAR(Harmonic(optics, 2), expected, 0.03 * expected);
  EXPECT_GT(Harmonic(optics, 4), 1e-5);
  EXPECT_LT(Harmonic(optics, 1), 1e-12);
  EXPECT_LT(Harmonic(optics, 3), 1e-12);
}

// Polarizer 0 turned by e: its channel grows by 2 d e sin(2 phi), p1 by half of that times
// (1 - p1), and dphi = -(1 / 3d) sin(2 phi) dp1 = -e/6 (1 - cos(4 phi)) (1 - d cos(2 phi)): a
// constant and 4 psi of size e/6, with 2 psi and 6 psi of the share d.
TEST(ReadSixChannels, APolarizersAngleErrorTurnsWithFourTimesPsi) {
  SixChannelOptics optics;
  optics.angle_error_rad[0] = 0.3 * kDegree;
  EXPECT_NEAR(Harmonic(optics, 4), 0.3 * kDegree / 6.0, 0.03 * 0.3 * kDegree / 6.0);
  EXPECT_LT(Harmonic(optics, 1), 1e-12);
}

TEST(ReadSixChannels, ADarkOffsetShowsInTheOpponentSum) {
  SixChannelOptics optics;
  optics.offset[2] = 0.01;
  const Decoded out = Decode(ReadSixChannels(optics, Turned(0.4), kOrigin, 0.0, ClearSky()));
  EXPECT_GT(std::abs(out.opponent_sum), 1e-3);
}

TEST(Digitize, RoundsToTheNearestOfTwoToTheNLevels) {
  const SixChannels reading = {0.1, 0.2, 0.333, 0.5, 0.9, 1.0};
  const SixChannels out = Digitize(reading, {}, 0.0, 12);
  for (std::size_t i = 0; i < out.size(); ++i) {
    EXPECT_NEAR(out[i], reading[i], 0.5 / 4095.0 + 1e-15);
    EXPECT_NEAR(out[i] * 4095.0, std::round(out[i] * 4095.0), 1e-9);
  }
}

TEST(Digitize, SaturatesAtFullScaleAndAtDark) {
  const SixChannels out = Digitize({1.7, -0.2, 0.5, 0.5, 0.5, 0.5}, {}, 0.0, 12);
  EXPECT_EQ(out[0], 1.0);
  EXPECT_EQ(out[1], 0.0);
}

TEST(Digitize, ScalesNoiseWithTheReading) {
  const SixChannels out =
      Digitize({0.1, 0.4, 0.5, 0.5, 0.5, 0.5}, {1.0, 1.0, -1.0, 0.0, 0.0, 0.0}, 0.1, 24);
  EXPECT_NEAR(out[0], 0.11, 1e-7);
  EXPECT_NEAR(out[1], 0.44, 1e-7);
  EXPECT_NEAR(out[2], 0.45, 1e-7);
  EXPECT_THROW(static_cast<void>(Digitize({}, {}, 0.0, 0)), std::logic_error);
}

TEST(AverageOverCone, TakesUnpolarizedLightFromHiddenRays) {
  const WorldSky sky = ClearSky();
  const auto average = [&](const Cover& cover) {
    return AverageOverCone(10.0 * kDegree, Turned(0.3), kOrigin, 0.0, sky, cover);
  };
  const ConeLight open = average({});
  const ConeLight same = average([](const Eigen::Vector3d&) { return std::nullopt; });
  EXPECT_EQ(open.i, same.i);
  EXPECT_EQ(open.q, same.q);
  EXPECT_EQ(open.u, same.u);
  const ConeLight closed = average([](const Eigen::Vector3d&) { return 0.25; });
  EXPECT_NEAR(closed.i, 0.25, 1e-15);
  EXPECT_EQ(closed.q, 0.0);
  EXPECT_EQ(closed.u, 0.0);
  const ConeLight black = average([](const Eigen::Vector3d&) { return 0.0; });
  EXPECT_EQ(black.i, 0.0);
  EXPECT_EQ(black.q, 0.0);
}

// exp(-depth / sin el) of the sky's light is left, the rest is the fog's own.
TEST(FogAbove, LetsThroughByBeersLawAndAddsUnpolarizedLight) {
  const FogAbove fog{.depth = 0.7, .radiance = 1.4};
  const Eigen::Vector3d sky(1.1, 0.3, -0.2);
  for (const double up : {1.0, 0.5}) {
    const double left = std::exp(-0.7 / up);
    const Eigen::Vector3d seen = fog.Through(sky, up);
    EXPECT_NEAR(seen[0], left * 1.1 + (1.0 - left) * 1.4, 1e-12);
    EXPECT_NEAR(seen[1], left * 0.3, 1e-12);
    EXPECT_NEAR(seen[2], left * -0.2, 1e-12);
  }
  EXPECT_EQ(FogAbove{}.Through(sky, 0.3), sky);
}

}  // namespace
}  // namespace polnav::sky
