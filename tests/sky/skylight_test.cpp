#include "sky/skylight.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "sky/rayleigh.h"
#include "sky/sun.h"

namespace polnav::sky {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
const Eigen::Vector3d kOrigin = Eigen::Vector3d::Zero();

SkyOptions Clear() {
  SkyOptions options;
  options.clouds = "clear";
  return options;
}

double Dop(const Skylight& light) { return std::hypot(light.q, light.u); }

std::vector<Eigen::Vector3d> Rays() {
  std::vector<Eigen::Vector3d> rays;
  for (double elevation = 2.0; elevation < 90.0; elevation += 8.0) {
    for (double azimuth = 0.0; azimuth < 360.0; azimuth += 17.0) {
      rays.push_back(DirectionEnu(azimuth * kDegree, elevation * kDegree));
    }
  }
  rays.push_back(Eigen::Vector3d::UnitZ());
  return rays;
}

TEST(WorldSky, AxesAreTransverseDownwardsAndClockwise) {
  const WorldSky sky(SkyOptions{}, DirectionEnu(0.3, 0.5), 1);
  for (const Eigen::Vector3d& ray : Rays()) {
    const Skylight light = sky.Look(ray, kOrigin, 0.0);
    EXPECT_NEAR(light.axis1_W.norm(), 1.0, 1e-14);
    EXPECT_LT((light.axis1_W.cross(light.axis2_W) + ray).norm(), 1e-14);
    EXPECT_LE(light.axis1_W.z(), 0.0);
    EXPECT_EQ(light.axis2_W.z(), 0.0);
  }
}

// Neutral points back in the sun: the two models are the same sky, and it is the estimator's.
TEST(WorldSky, WithoutSeparationIsRayleigh) {
  const Eigen::Vector3d sun = DirectionEnu(4.0, 0.3);
  SkyOptions options = Clear();
  options.clear.separation_scale = 0.0;
  const WorldSky berry(options, sun, 1);
  options.clear.model = "rayleigh";
  const WorldSky rayleigh(options, sun, 1);
  for (const Eigen::Vector3d& ray : Rays()) {
    const Skylight light = berry.Look(ray, kOrigin, 0.0);
    Eigen::Matrix3d R_PW;  // right-handed about the ray: the second axis against the compass
    R_PW << light.axis1_W.transpose(), -light.axis2_W.transpose(), ray.transpose();
    const Eigen::Vector2d expected = RayleighStokes<double>(R_PW * sun, options.clear.max_dop);
    EXPECT_NEAR(light.q, expected.x(), 1e-14);
    EXPECT_NEAR(light.u, -expected.y(), 1e-14);
    const Skylight same = rayleigh.Look(ray, kOrigin, 0.0);
    EXPECT_NEAR(light.q, same.q, 1e-14);
    EXPECT_NEAR(light.u, same.u, 1e-14);
  }
}

// A symmetric sky: seen in the solar meridian's mirror, Q is the same and U is reversed.
TEST(WorldSky, IsSymmetricAboutTheSolarMeridian) {
  const WorldSky sky(Clear(), DirectionEnu(0.0, 0.4), 1);
  for (double azimuth = 0.1; azimuth < 3.1; azimuth += 0.3) {
    const Skylight east = sky.Look(DirectionEnu(azimuth, 0.7), kOrigin, 0.0);
    const Skylight west = sky.Look(DirectionEnu(-azimuth, 0.7), kOrigin, 0.0);
    EXPECT_NEAR(east.q, west.q, 1e-14);
    EXPECT_NEAR(east.u, -west.u, 1e-14);
    EXPECT_NEAR(east.radiance, west.radiance, 1e-14);
  }
}

TEST(WorldSky, IsFiniteAndPositiveEverywhereWhateverTheSun) {
  for (const double sun_elevation : {-40.0, 0.0, 16.5, 89.999, 90.0}) {
    const WorldSky sky(SkyOptions{}, DirectionEnu(1.0, sun_elevation * kDegree), 1);
    std::vector<Eigen::Vector3d> rays = Rays();
    rays.push_back(sky.sun_W());
    rays.push_back(Eigen::Vector3d::UnitX());
    rays.push_back(-Eigen::Vector3d::UnitZ());
    for (const Eigen::Vector3d& ray : rays) {
      const Skylight light = sky.Look(ray, kOrigin, 3.0);
      EXPECT_TRUE(std::isfinite(light.radiance));
      EXPECT_GT(light.radiance, 0.0);
      EXPECT_LE(Dop(light), SkyOptions{}.clear.max_dop + 1e-14);
    }
  }
}

TEST(WorldSky, IsBrightestAtTheSunAndOneAtTheClearZenith) {
  const WorldSky sky(Clear(), DirectionEnu(1.0, 0.6), 1);
  EXPECT_DOUBLE_EQ(sky.Look(Eigen::Vector3d::UnitZ(), kOrigin, 0.0).radiance, 1.0);
  const double at_sun = sky.Look(sky.sun_W(), kOrigin, 0.0).radiance;
  for (const Eigen::Vector3d& ray : Rays()) {
    EXPECT_LT(sky.Look(ray, kOrigin, 0.0).radiance, at_sun);
  }
}

TEST(WorldSky, BelowTheHorizonLooksAsTheHorizon) {
  const WorldSky sky(SkyOptions{}, DirectionEnu(1.0, 0.6), 1);
  const Skylight below = sky.Look(DirectionEnu(2.0, -0.5), kOrigin, 0.0);
  const Skylight horizon = sky.Look(DirectionEnu(2.0, 0.0), kOrigin, 0.0);
  EXPECT_NEAR(below.radiance, horizon.radiance, 1e-12);
  EXPECT_NEAR(below.q, horizon.q, 1e-12);
  EXPECT_NEAR(below.u, horizon.u, 1e-12);
}

// Thin cloud takes polarization away, and is brighter than the blue but not than the sun's glow.
TEST(WorldSky, ThinCloudDepolarizesAndBrightensTheBlue) {
  const Eigen::Vector3d sun = DirectionEnu(4.0, 0.3);
  const WorldSky clear(Clear(), sun, 5);
  const WorldSky veiled(SkyOptions{}, sun, 5);
  for (const Eigen::Vector3d& ray : Rays()) {
    const Skylight a = clear.Look(ray, kOrigin, 7.0);
    const Skylight b = veiled.Look(ray, kOrigin, 7.0);
    EXPECT_LT(Dop(b), Dop(a));
    if (a.radiance < 3.0) {
      EXPECT_GT(b.radiance, a.radiance);
    }
  }
}

// At every instant it is the sky of the sun that stands there then.
TEST(WorldSky, FollowsTheMovingSun) {
  const SunArc arc{.start_W = DirectionEnu(4.0, 0.3), .turn_W_rad_s = {0.0, -6e-5, -4e-5}};
  const WorldSky moving(Clear(), arc, 1);
  const WorldSky still(Clear(), arc.At(600.0), 1);
  EXPECT_GT((moving.sun_W(600.0) - moving.sun_W()).norm(), 0.02);
  for (const Eigen::Vector3d& ray : Rays()) {
    EXPECT_EQ(moving.Look(ray, kOrigin, 600.0).q, still.Look(ray, kOrigin, 0.0).q);
    EXPECT_EQ(moving.Look(ray, kOrigin, 600.0).radiance, still.Look(ray, kOrigin, 0.0).radiance);
  }
}

TEST(WorldSky, RefusesABrokenSunRayOrModel) {
  EXPECT_THROW(WorldSky(SkyOptions{}, Eigen::Vector3d(0.0, 0.0, 2.0), 1), std::logic_error);
  const WorldSky sky(SkyOptions{}, Eigen::Vector3d::UnitZ(), 1);
  EXPECT_THROW(static_cast<void>(sky.Look(Eigen::Vector3d::Zero(), kOrigin, 0.0)),
               std::logic_error);
  SkyOptions options;
  options.clear.model = "perez";
  EXPECT_THROW(WorldSky(options, Eigen::Vector3d::UnitZ(), 1), std::invalid_argument);
}

}  // namespace
}  // namespace polnav::sky
