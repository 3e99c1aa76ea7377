#include "sim/sensors/polarimeter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sky/sun.h"

namespace polnav::sim {
namespace {

using nav::DegToRad;
using nav::RadToDeg;

const double kSunAzimuth = DegToRad(230.09);
const double kSunElevation = DegToRad(16.5);

sky::WorldSky Sky(double cover) {
  sky::SkyOptions options;
  options.thin_cloud_cover = cover;
  return {options, sky::DirectionEnu(kSunAzimuth, kSunElevation), 5};
}

PolarimeterOptions Perfect() {
  PolarimeterOptions options;
  options.channel_sigma = 0.0;
  options.bits = 24;
  options.gain_sigma = 0.0;
  options.polarizer_angle_sigma_deg = 0.0;
  options.mount_error_sigma_deg = 0.0;
  return options;
}

// A car at a heading, rolled and pitched, at rest, at its own place and time.
Truth CarAt(double heading, double roll, double pitch, double t_s) {
  Truth truth;
  truth.stamp = nav::FromSeconds(t_s);
  truth.T_WB.q = nav::LevelAttitude(heading) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                 Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
  return truth;
}

// The plain zenith formula: [Zeng2020, eq. 8] and then [Chu2021, eq. 8], the E-vector across the
// sun's azimuth. Polarizer angles count from x forward towards y left, a compass the other way.
double HeadingError(const nav::PolarizationSample& sample, const Truth& truth) {
  const std::array<double, 6>& c = sample.channel;
  const double p1 = (c[0] - c[1]) / (c[0] + c[1]);
  const double p2 = (c[2] - c[3]) / (c[2] + c[3]);
  const double p3 = (c[4] - c[5]) / (c[4] + c[5]);
  const double phi = 0.5 * std::atan2(std::sqrt(3.0) * (p2 - p3), 2.0 * p1 - p2 - p3);
  const double heading = phi + kSunAzimuth + 0.5 * std::numbers::pi;
  return nav::WrapHalfPi(heading - nav::CompassHeading(truth.T_WB.q));
}

// RMS in degrees over a car's drives: 40 instruments, each over 50 headings far apart in time.
double Rms(const PolarimeterOptions& options, double cover, double tilt_sigma_deg) {
  const sky::WorldSky sky = Sky(cover);
  double square = 0.0;
  for (std::uint64_t trial = 0; trial < 40; ++trial) {
    const Polarimeter sensor(options, sky, 1, trial);
    const RandomStream road(1, trial, "test/road");
    for (std::uint64_t i = 0; i < 50; ++i) {
      RandomStream::Sample draw = road.At(i);
      const double heading = 2.0 * std::numbers::pi * draw.Uniform();
      const double roll = DegToRad(tilt_sigma_deg) * draw.Gaussian();
      const double pitch = DegToRad(tilt_sigma_deg) * draw.Gaussian();
      const Truth truth = CarAt(heading, roll, pitch, 100.0 * static_cast<double>(50 * trial + i));
      square += std::pow(HeadingError(sensor.Sample(truth, i), truth), 2);
    }
  }
  return RadToDeg(std::sqrt(square / 2000.0));
}

TEST(Polarimeter, APerfectOneOnALevelCarUnderAClearSkyIsExact) {
  EXPECT_LT(Rms(Perfect(), 0.0, 0.0), 1e-5);  // 24 bits of a converter
}

// The budget that the header states, cause by cause, rounded to 0.1. 40 instruments give an RMS of
// fixed errors to 11 percent, 2000 readings one of white errors to 2.
TEST(Polarimeter, KeepsTheBudgetOfItsHeader) {
  const PolarimeterOptions defaults;
  PolarimeterOptions noise = Perfect();
  noise.channel_sigma = defaults.channel_sigma;
  noise.bits = defaults.bits;
  PolarimeterOptions optics = Perfect();
  optics.gain_sigma = defaults.gain_sigma;
  optics.polarizer_angle_sigma_deg = defaults.polarizer_angle_sigma_deg;
  PolarimeterOptions mounting = Perfect();
  mounting.mount_error_sigma_deg = defaults.mount_error_sigma_deg;
  const double cover = 0.15;
  struct Part {
    const char* cause;
    double rms, expected;
  };
  for (const Part& part : {
           Part{"noise", Rms(noise, 0.0, 0.0), 0.95},
           Part{"optics", Rms(optics, 0.0, 0.0), 0.1},
           Part{"mounting", Rms(mounting, 0.0, 0.0), 0.15},
           Part{"cloud", Rms(Perfect(), cover, 0.0), 0.5},
           Part{"tilt", Rms(Perfect(), 0.0, 1.5), 0.5},
           Part{"all", Rms(defaults, cover, 1.5), 1.25},
       }) {
    EXPECT_NEAR(part.rms, part.expected, 0.05 + 0.11 * part.expected) << part.cause;
  }
}

// [Chu2021]: "better than 2 degrees outdoors".
TEST(Polarimeter, OutdoorsASingleHeadingErrsByOneToTwoDegrees) {
  const double rms = Rms(PolarimeterOptions{}, 0.15, 1.5);
  EXPECT_GT(rms, 1.0);
  EXPECT_LT(rms, 2.0);
}

TEST(Polarimeter, SamplesAreTheSameInAnyOrder) {
  const sky::WorldSky sky = Sky(0.15);
  const Polarimeter a({}, sky, 3, 4);
  const Polarimeter b({}, sky, 3, 4);
  const Truth truth = CarAt(0.3, 0.0, 0.0, 1.0);
  const nav::PolarizationSample first = a.Sample(truth, 0);
  const nav::PolarizationSample second = a.Sample(truth, 1);
  EXPECT_EQ(b.Sample(truth, 1).channel, second.channel);
  EXPECT_EQ(b.Sample(truth, 0).channel, first.channel);
  EXPECT_NE(first.channel, second.channel);
  EXPECT_NE(Polarimeter({}, sky, 3, 5).Sample(truth, 0).channel, first.channel);
  EXPECT_EQ(first.stamp, truth.stamp);
}

// The default exposure leaves room for the bright side of a cloudy sky.
TEST(Polarimeter, DoesNotSaturateAtTheDefaults) {
  const sky::WorldSky sky = Sky(0.15);
  const Polarimeter sensor({}, sky, 3, 4);
  for (int i = 0; i < 200; ++i) {
    for (const double c : sensor.Sample(CarAt(0.1 * i, 0.15, -0.15, 37.0 * i), 0).channel) {
      EXPECT_LT(c, 0.95);
      EXPECT_GT(c, 0.02);
    }
  }
}

// A slab of radiance L covers a little more than the half of the sky with x > 0: of each ring's
// twelve rays the five that lean to x > 0 are hidden. L is that of the open cone, so that light
// stays and the degree of polarization falls to 7/12; over a cone of 10 degrees the sky's own
// slope, 3 percent to the rim, moves that by less than 0.03.
TEST(Polarimeter, LosesTheHiddenShareOfThePolarizationUnderASlab) {
  const sky::WorldSky sky = Sky(0.0);
  const Truth truth = CarAt(0.5 * std::numbers::pi, 0.0, 0.0, 0.0);  // x east, y north
  const Polarimeter open(Perfect(), sky, 1, 0);
  const auto light = [](const nav::PolarizationSample& sample) {
    const std::array<double, 6>& c = sample.channel;
    const double q = (c[0] - c[1]) / (c[0] + c[1]);
    const double u =
        ((c[2] - c[3]) / (c[2] + c[3]) - (c[4] - c[5]) / (c[4] + c[5])) / std::sqrt(3.0);
    return std::pair(0.5 * (c[0] + c[1]), std::hypot(q, u));
  };
  const auto [open_light, open_dop] = light(open.Sample(truth, 0));
  const double radiance = open_light / PolarimeterOptions{}.exposure;

  Scene scene;
  Mesh& slab = scene.meshes.emplace_back(Mesh{.label = Label::kStructure});
  for (const auto& [x, y] : {std::pair{0.02F, -9.0F}, {0.02F, 9.0F}, {9.0F, 9.0F}, {9.0F, -9.0F}}) {
    slab.vertices.push_back({{x, y, 6.0F}, -Eigen::Vector3f::UnitZ(), {0.0F, 0.0F}});
  }
  slab.indices = {0, 1, 2, 0, 2, 3};
  constexpr double kStructureReflectance = 0.4;
  const Occlusion occlusion(
      scene, [&](const Eigen::Vector3d&) { return radiance / kStructureReflectance; });
  const auto [half_light, half_dop] =
      light(Polarimeter(Perfect(), sky, 1, 0, &occlusion).Sample(truth, 0));
  EXPECT_NEAR(half_light, open_light, 0.03 * open_light);
  EXPECT_NEAR(half_dop / open_dop, 7.0 / 12.0, 0.03);
  // Away from it, with noise and all, it reads the same bits as under the open sky.
  Truth beside = truth;
  beside.T_WB.p.x() = -3.0;
  EXPECT_EQ(Polarimeter({}, sky, 1, 0, &occlusion).Sample(beside, 3).channel,
            Polarimeter({}, sky, 1, 0).Sample(beside, 3).channel);
}

TEST(NominalPolarimeter, LooksUpWithoutItsTrueErrors) {
  const nav::PolarimeterCalibration nominal = NominalPolarimeter({});
  EXPECT_EQ(nominal.T_BS.q.angularDistance(Eigen::Quaterniond::Identity()), 0.0);
  EXPECT_DOUBLE_EQ(nominal.fov_rad, DegToRad(10.0));
}

}  // namespace
}  // namespace polnav::sim
