#include "sky/clouds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>

#include "sky/rayleigh.h"
#include "sky/skylight.h"
#include "sky/sun.h"

namespace polnav::sky {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
const Eigen::Vector3d kOrigin = Eigen::Vector3d::Zero();
const Eigen::Vector3d kZenith = Eigen::Vector3d::UnitZ();

// Places on the ground, kilometres apart, so that each has its own cloud overhead.
Eigen::Vector3d Place(int i) { return {3137.0 * (i % 100), 3731.0 * (i / 100), 0.0}; }

TEST(CloudLayer, WithoutCloudIsEmpty) {
  const CloudLayer layer(WeatherOf("clear"), {5.0, 0.0}, 1);
  EXPECT_TRUE(layer.empty());
  EXPECT_EQ(layer.Look(kZenith, kOrigin, 3.0).transmittance, 1.0);
}

// A cover of c is the share of the sky with thick cloud. 2500 places, each its own cloud or nearly:
// three sigma are 0.03, and the field is not quite Gaussian.
TEST(CloudLayer, HasTheCoverAskedFor) {
  for (const double cover : {0.2, 0.5, 0.75}) {
    const CloudLayer layer({.cover = cover, .optical_depth = 5.0}, {0.0, 0.0}, 4);
    int cloudy = 0;
    double depth = 0.0;
    for (int i = 0; i < 2500; ++i) {
      const double here = layer.Look(kZenith, Place(i), 0.0).optical_depth;
      cloudy += here > 0.0 ? 1 : 0;
      depth += here;
    }
    EXPECT_NEAR(cloudy / 2500.0, cover, 0.04);
    EXPECT_NEAR(depth / cloudy, 5.0, 0.5);  // the mean where there is some
  }
}

// Frozen: what passes overhead now was upwind before. The field is rounded to 1e-6.
TEST(CloudLayer, IsCarriedByTheWind) {
  const CloudLayer layer(WeatherOf("many_clouds"), {5.0, -3.0}, 9);
  for (double t = 0.0; t < 500.0; t += 50.0) {
    const CloudColumn later = layer.Look(kZenith, kOrigin, t);
    const CloudColumn before = layer.Look(kZenith, {-5.0 * t, 3.0 * t, 0.0}, 0.0);
    EXPECT_NEAR(later.transmittance, before.transmittance, 1e-4);
    EXPECT_NEAR(std::abs(later.kept - before.kept), 0.0, 1e-4);
  }
}

// At 8 m/s a cloud that takes 20 s to pass is 160 m wide; its ragged edge, 0.3 of the radius with a
// sigma of 0.1, is some 5 s of it.
TEST(CloudLayer, LetsACloudPassWhenItIsToldTo) {
  const CloudLayer layer(WeatherOf("clear"), {8.0, 0.0}, 1,
                         {{.middle_s = 50.0, .duration_s = 20.0, .optical_depth = 4.0}});
  EXPECT_FALSE(layer.empty());
  EXPECT_EQ(layer.Look(kZenith, kOrigin, 30.0).transmittance, 1.0);
  EXPECT_NEAR(layer.Look(kZenith, kOrigin, 50.0).optical_depth, 4.0, 1e-12);
  EXPECT_EQ(layer.Look(kZenith, kOrigin, 70.0).transmittance, 1.0);
  // Downwind it comes later: 400 m at 8 m/s are 50 s.
  EXPECT_NEAR(layer.Look(kZenith, {400.0, 0.0, 0.0}, 100.0).optical_depth, 4.0, 1e-12);
  EXPECT_THROW(CloudLayer(WeatherOf("clear"), {0.0, 0.0}, 1, {{}}), std::logic_error);
}

// A ray at 30 degrees meets twice the depth (less for the earth's curve, 0.1 percent here).
TEST(CloudLayer, IsDeeperAlongASlantedRay) {
  const CloudLayer layer(WeatherOf("overcast"), {0.0, 0.0}, 2);
  for (int i = 0; i < 20; ++i) {
    const CloudColumn slanted = layer.Look(DirectionEnu(1.0, 30.0 * kDegree), Place(i), 0.0);
    EXPECT_NEAR(-std::log(slanted.transmittance), 2.0 * slanted.optical_depth,
                0.002 * slanted.optical_depth);
  }
}

TEST(CloudLayer, IsFiniteAtTheHorizon) {
  const CloudColumn column = CloudLayer(WeatherOf("few_clouds"), {1.0, 0.0}, 3)
                                 .Look(Eigen::Vector3d::UnitX(), kOrigin, 1.0);
  EXPECT_TRUE(std::isfinite(column.transmittance));
  EXPECT_TRUE(std::isfinite(std::abs(column.kept)));
}

// Silver lining: thin cloud before the sun outshines thick cloud there, and thin cloud elsewhere.
TEST(CloudRadiance, IsBrightestAtThinEdgesBeforeTheSun) {
  EXPECT_GT(CloudRadiance(0.5, 0.99, 0.5), 2.0 * CloudRadiance(20.0, 0.99, 0.5));
  EXPECT_GT(CloudRadiance(0.5, 0.99, 0.5), 1.5 * CloudRadiance(0.5, 0.0, 0.5));
}

// [CIE2003]: an overcast zenith is three times as bright as the horizon; thick cloud comes near.
TEST(CloudRadiance, OfThickCloudIsBrightestOverhead) {
  const double ratio = CloudRadiance(100.0, 0.0, 1.0) / CloudRadiance(100.0, 0.0, 0.0);
  EXPECT_GT(ratio, 2.3);
  EXPECT_LT(ratio, 3.0);
}

TEST(AirPolarization, LiesAcrossTheWayOfTheLight) {
  EXPECT_LT(AirPolarization({1.0, 0.0}).real(), 0.0);
  EXPECT_GT(AirPolarization({0.0, 1.0}).real(), 0.0);
}

TEST(WeatherOf, KnowsItsPresetsOnly) {
  EXPECT_THROW(static_cast<void>(WeatherOf("hail")), std::invalid_argument);
  EXPECT_THROW(CloudLayer({.cover = 1.5}, {0.0, 0.0}, 1), std::logic_error);
}

struct Statistics {
  double within_5_deg = 0.0;  // share of the sky, of Rayleigh's angle
  double highest_dop = 0.0;
  double mean_dop = 0.0;
  double gap_dop = 0.0;  // mean over that of the clear sky, where light comes through undimmed
  double turned =
      0.0;  // share under thick cloud within 20 degrees of a right angle to the clear sky
};

// Twenty skies by equal solid angles, suns of 3, 8 and 13 degrees: the published share is of low
// suns.
Statistics Measure(const std::string& preset) {
  Statistics sum;
  double rays = 0.0, gaps = 0.0, gap_clear = 0.0, gap_dop = 0.0, thick = 0.0;
  for (int sky_index = 0; sky_index < 20; ++sky_index) {
    SkyOptions options;
    options.clear.model = "hazy";
    options.clouds = preset;
    const double sun_deg = 3.0 + 5.0 * (sky_index % 3);
    const WorldSky sky(options, DirectionEnu(0.7, sun_deg * kDegree),
                       static_cast<std::uint64_t>(sky_index));
    const SkyInstant now = sky.At(0.0);
    for (int ring = 0; ring < 24; ++ring) {
      for (int sector = 0; sector < 48; ++sector) {
        const Eigen::Vector3d ray =
            DirectionEnu(7.5 * sector * kDegree, std::asin((ring + 0.5) / 24.0));
        const Skylight light = now.Look(ray, kOrigin);
        const Eigen::Vector3d sun(light.axis1_W.dot(sky.sun_W()), light.axis2_W.dot(sky.sun_W()),
                                  ray.dot(sky.sun_W()));
        const Eigen::Vector2d rayleigh = RayleighStokes<double>(sun, 1.0);
        const SkyStokes<double> clear = now.clear().Look(ray);
        const double angle = std::atan2(light.u, light.q);
        const double from_rayleigh =
            0.5 *
            std::remainder(angle - std::atan2(rayleigh.y(), rayleigh.x()), 2.0 * std::numbers::pi);
        const double from_clear =
            0.5 * std::remainder(angle - std::atan2(clear.u, clear.q), 2.0 * std::numbers::pi);
        const double dop = std::hypot(light.q, light.u);
        const double transmittance = now.Transmittance(ray, kOrigin);
        rays += 1.0;
        sum.within_5_deg += std::abs(from_rayleigh) < 5.0 * kDegree ? 1.0 : 0.0;
        sum.mean_dop += dop;
        sum.highest_dop = std::max(sum.highest_dop, dop);
        if (transmittance > 0.999) {
          gaps += 1.0;
          gap_dop += dop;
          gap_clear += std::hypot(clear.q, clear.u);
        } else if (transmittance < 0.1) {
          thick += 1.0;
          sum.turned += std::abs(from_clear) > 70.0 * kDegree ? 1.0 : 0.0;
        }
      }
    }
  }
  sum.within_5_deg /= rays;
  sum.mean_dop /= rays;
  sum.gap_dop = gaps > 0.0 ? gap_dop / gap_clear : 0.0;
  sum.turned = thick > 0.0 ? sum.turned / thick : 0.0;
  std::printf("%-12s within 5 deg %.2f, DoP mean %.3f highest %.3f, gaps keep %.2f, turned %.3f\n",
              preset.c_str(), sum.within_5_deg, sum.mean_dop, sum.highest_dop, sum.gap_dop,
              sum.turned);
  return sum;
}

// The table of docs/clouds.md. Published: an overcast sky's degree is at most 0.16 [Hegedus2007];
// under a sun of at most 13 degrees, 40 to 70 % of a clear sky lies within 5 degrees of Rayleigh's
// angle, less under cloud [Suhai2004]. Clear air as radiative transfer has it does better than
// skies that were measured; the others lie in the range or below it.
TEST(Presets, KeepToPublishedStatistics) {
  const Statistics clear = Measure("clear");
  const Statistics few = Measure("few_clouds");
  const Statistics many = Measure("many_clouds");
  const Statistics overcast = Measure("overcast");
  EXPECT_LE(overcast.highest_dop, 0.16);
  EXPECT_GT(overcast.highest_dop, 0.05);  // cloud keeps some
  EXPECT_GT(clear.within_5_deg, 0.70);
  EXPECT_LT(few.within_5_deg, 0.71);
  EXPECT_GT(many.within_5_deg, 0.40);
  EXPECT_LT(many.within_5_deg, 0.70);
  EXPECT_LT(overcast.within_5_deg, 0.40);
  EXPECT_GT(overcast.within_5_deg, 0.20);  // the angle is mostly kept: chance would be 0.06
  // Light between clouds takes polarization from the gaps [Pomozi2001].
  EXPECT_LT(few.gap_dop, 0.98);
  EXPECT_GT(few.gap_dop, 0.7);
  EXPECT_LT(many.gap_dop, few.gap_dop);
  // A small class of clouds is polarized at right angles [Pust2008].
  EXPECT_GT(overcast.turned, 0.01);
  EXPECT_LT(overcast.turned, 0.15);
}

// What skylight.h promises: readings at the zenith carry about 0.5 degrees of correlated error at
// the default cover. 2000 clouds, neighbours at half a length, give the RMS to 3 percent; the
// field is not quite Gaussian.
TEST(WorldSky, DefaultCloudTurnsTheZenithByHalfADegree) {
  const double sun_azimuth = 230.0 * kDegree;
  const WorldSky sky(SkyOptions{}, DirectionEnu(sun_azimuth, 16.5 * kDegree), 11);
  double square = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const Skylight light = sky.Look(kZenith, kOrigin, 200.0 * i);
    const double phi = 0.5 * std::atan2(light.u, light.q);  // from north, clockwise
    square +=
        std::pow(std::remainder(phi - sun_azimuth - 0.5 * std::numbers::pi, std::numbers::pi), 2);
  }
  EXPECT_NEAR(std::sqrt(square / 2000.0) / kDegree, 0.55, 0.1);
}

TEST(WorldSky, IsAFunctionOfSeedPlaceAndTimeOnly) {
  SkyOptions options;
  options.clouds = "many_clouds";
  const Eigen::Vector3d sun = DirectionEnu(1.0, 0.4);
  const WorldSky a(options, sun, 42);
  const WorldSky b(options, sun, 42);
  const WorldSky other(options, sun, 43);
  const Eigen::Vector3d ray = DirectionEnu(0.2, 1.1);
  static_cast<void>(a.Look(kZenith, kOrigin, 99.0));
  EXPECT_EQ(a.Look(ray, kOrigin, 5.0).q, b.Look(ray, kOrigin, 5.0).q);
  EXPECT_EQ(a.Look(ray, kOrigin, 5.0).u, b.Look(ray, kOrigin, 5.0).u);
  EXPECT_NE(a.Look(ray, kOrigin, 5.0).radiance, other.Look(ray, kOrigin, 5.0).radiance);
}

}  // namespace
}  // namespace polnav::sky
