#include "nav/polarization/mirror_patches.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace polnav::nav {
namespace {

constexpr double kSun_rad = 0.7;

Eigen::Vector3d Ray(double from_sun_rad, double elevation_rad) {
  const double angle = kSun_rad + from_sun_rad;
  return {std::cos(elevation_rad) * std::cos(angle), std::cos(elevation_rad) * std::sin(angle),
          std::sin(elevation_rad)};
}

TEST(MirrorPatches, ARayAndItsMirrorImageAboutTheMeridianShareAPatch) {
  const MirrorPatches patches(0.2);
  for (double elevation = 0.05; elevation < 1.5; elevation += 0.1) {
    for (double from_sun = 0.05; from_sun < 3.1; from_sun += 0.1) {
      const MirrorPatch left = patches.Of(Ray(from_sun, elevation), kSun_rad);
      const MirrorPatch right = patches.Of(Ray(-from_sun, elevation), kSun_rad);
      EXPECT_EQ(left.index, right.index);
      EXPECT_EQ(left.side, -right.side);
      EXPECT_LT(left.index, patches.count());
    }
  }
}

// Half a sky of solid angle pi, patches of 0.2 by 0.2: some 79.
TEST(MirrorPatches, AreAboutAsLargeAsAskedFor) {
  EXPECT_NEAR(static_cast<double>(MirrorPatches(0.2).count()), 79.0, 8.0);
}

TEST(MirrorPatches, StayWithTheSkyWhileTheCameraTurns) {
  const MirrorPatches patches(0.2);
  const Eigen::Vector3d ray = Ray(0.9, 0.6);
  const MirrorPatch before = patches.Of(ray, kSun_rad);
  const Eigen::Vector3d turned = Eigen::AngleAxisd(1.3, Eigen::Vector3d::UnitZ()) * ray;
  EXPECT_EQ(patches.Of(turned, kSun_rad + 1.3).index, before.index);
}

TEST(MirrorPatches, RaysBelowTheHorizonCountAsOnIt) {
  const MirrorPatches patches(0.2);
  EXPECT_EQ(patches.Of(Ray(0.9, -0.3), kSun_rad).index, patches.Of(Ray(0.9, 0.0), kSun_rad).index);
}

}  // namespace
}  // namespace polnav::nav
