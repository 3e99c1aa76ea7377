#include "sky/clouds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sky/skylight.h"
#include "sky/sun.h"

namespace polnav::sky {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
const Eigen::Vector3d kOrigin = Eigen::Vector3d::Zero();
const Eigen::Vector3d kZenith = Eigen::Vector3d::UnitZ();

// Places far from each other in correlation lengths, and off the lattice's own grid.
Eigen::Vector2d Place(int i) { return {3.137 * (i % 100), 3.731 * (i / 100)}; }

double Correlation(double lag) {
  double product = 0.0;
  double square = 0.0;
  for (int i = 0; i < 10000; ++i) {
    const double here = LatticeNoise(Place(i), 7);
    product += here * LatticeNoise(Place(i) + Eigen::Vector2d(0.6 * lag, 0.8 * lag), 7);
    square += here * here;
  }
  return product / square;
}

// 10000 places, neighbours at three correlation lengths: the mean is known to 0.01 and the
// deviation to 0.01; tolerances are five of these.
TEST(LatticeNoise, IsCentredAndOfUnitDeviation) {
  double sum = 0.0;
  double square = 0.0;
  for (int i = 0; i < 10000; ++i) {
    const double value = LatticeNoise(Place(i), 3);
    sum += value;
    square += value * value;
  }
  EXPECT_NEAR(sum / 10000.0, 0.0, 0.05);
  EXPECT_NEAR(std::sqrt(square / 10000.0), 1.0, 0.05);
}

// The correlation length is where it passes 1/e = 0.37.
TEST(LatticeNoise, CorrelationFallsWithLag) {
  EXPECT_GT(Correlation(0.1), 0.95);
  EXPECT_NEAR(Correlation(1.0), 0.37, 0.05);
  EXPECT_LT(std::abs(Correlation(2.0)), 0.15);
  EXPECT_LT(std::abs(Correlation(10.0)), 0.05);
  EXPECT_GT(Correlation(0.25), Correlation(0.5));
  EXPECT_GT(Correlation(0.5), Correlation(1.0));
}

// Adjacent seeds: 10000 nearly independent pairs, so 5 sigma is 0.05.
TEST(LatticeNoise, OtherSeedsAreOtherClouds) {
  double product = 0.0;
  for (int i = 0; i < 10000; ++i) {
    product += LatticeNoise(Place(i), 7) * LatticeNoise(Place(i), 8);
  }
  EXPECT_NEAR(product / 10000.0, 0.0, 0.05);
}

// A dense walk over many cell borders of all octaves. Each octave slopes by at most its frequency
// times its amplitude (1.9) times 5 (gradients within 1.4, and the fade's 15/8 times differences):
// four of them move it by 0.04 in a step of 0.001. A break would be of the order of 1.
TEST(LatticeNoise, IsContinuous) {
  double last = LatticeNoise({-10.0, 6.0}, 7);
  for (int i = 1; i <= 20000; ++i) {
    const double here = LatticeNoise({-10.0 + 0.8e-3 * i, 6.0 - 0.6e-3 * i}, 7);
    ASSERT_LT(std::abs(here - last), 0.04) << i;
    last = here;
  }
}

TEST(LookAtClouds, NoCoverIsClearAndFullCoverIsAllCloud) {
  CloudLayer layer;
  layer.cover = 0.0;
  EXPECT_EQ(LookAtClouds(layer, kZenith, kOrigin, 0.0).share, 0.0);
  layer.cover = 1.0;
  EXPECT_EQ(LookAtClouds(layer, kZenith, kOrigin, 0.0).share, 1.0);
}

// The cover is the median. Odds are log-normal of sigma 0.45, so for a small cover the mean is
// exp(0.45^2 / 2) = 1.107 of it; for a large one the two meet. Sampling adds 1 percent.
TEST(LookAtClouds, HasTheMeanShareAskedFor) {
  for (const double cover : {0.05, 0.15, 0.5, 0.9}) {
    CloudLayer layer;
    layer.cover = cover;
    double sum = 0.0;
    for (int i = 0; i < 10000; ++i) {
      const Eigen::Vector2d place = Place(i) * layer.scale_m;
      sum += LookAtClouds(layer, kZenith, {place.x(), place.y(), 0.0}, 0.0).share;
    }
    EXPECT_NEAR(sum / 10000.0, cover, std::min(0.15 * cover, 0.02));
  }
}

// Frozen: what passes overhead now was upwind before.
TEST(LookAtClouds, TheWindCarriesTheLayer) {
  CloudLayer layer;
  layer.cover = 0.3;
  layer.wind_m_s = {5.0, -3.0};
  layer.seed = 9;
  for (double t = 0.0; t < 500.0; t += 50.0) {
    const Eigen::Vector3d upwind(-5.0 * t, 3.0 * t, 0.0);
    const CloudLight later = LookAtClouds(layer, kZenith, kOrigin, t);
    const CloudLight before = LookAtClouds(layer, kZenith, upwind, 0.0);
    EXPECT_NEAR(later.share, before.share, 1e-12);
    EXPECT_NEAR(later.turn_rad, before.turn_rad, 1e-12);
  }
}

TEST(LookAtClouds, IsFiniteAtTheHorizon) {
  CloudLayer layer;
  layer.cover = 0.3;
  const CloudLight light = LookAtClouds(layer, Eigen::Vector3d::UnitX(), kOrigin, 1.0);
  EXPECT_GT(light.share, 0.0);
  EXPECT_LT(light.share, 1.0);
  EXPECT_TRUE(std::isfinite(light.turn_rad));
}

// What the headers promise: readings at the zenith carry about 0.5 degrees of correlated error at
// the default cover. 2000 independent clouds give the RMS to 2 percent; the field is not quite
// Gaussian.
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
  const Eigen::Vector3d sun = DirectionEnu(1.0, 0.4);
  const WorldSky a(SkyOptions{}, sun, 42);
  const WorldSky b(SkyOptions{}, sun, 42);
  const WorldSky other(SkyOptions{}, sun, 43);
  const Eigen::Vector3d ray = DirectionEnu(0.2, 1.1);
  static_cast<void>(a.Look(kZenith, kOrigin, 99.0));
  EXPECT_EQ(a.Look(ray, kOrigin, 5.0).q, b.Look(ray, kOrigin, 5.0).q);
  EXPECT_EQ(a.Look(ray, kOrigin, 5.0).u, b.Look(ray, kOrigin, 5.0).u);
  EXPECT_NE(a.Look(ray, kOrigin, 5.0).q, other.Look(ray, kOrigin, 5.0).q);
}

}  // namespace
}  // namespace polnav::sky
