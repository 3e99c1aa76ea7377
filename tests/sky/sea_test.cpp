#include "sky/sea.h"

#include <gtest/gtest.h>

#include <cmath>

namespace polnav::sky {
namespace {

// ((n - 1) / (n + 1))^2 = 0.0211 for n = 1.34, the same for both polarizations but for the sign.
TEST(ReflectanceOfWater, IsTwoPercentFromAbove) {
  const Fresnel r = ReflectanceOfWater(1.0);
  EXPECT_NEAR(r.s * r.s, std::pow(0.34 / 2.34, 2), 1e-15);
  EXPECT_NEAR(r.s, -r.p, 1e-15);
}

TEST(ReflectanceOfWater, IsAllAtGrazingAndHalfAtBrewstersAngle) {
  EXPECT_NEAR(ReflectanceOfWater(0.0).s, -1.0, 1e-15);
  EXPECT_NEAR(ReflectanceOfWater(0.0).p, -1.0, 1e-15);
  EXPECT_NEAR(ReflectanceOfWater(std::cos(std::atan(1.34))).p, 0.0, 1e-15);
}

// Slopes of 0.001 spread a ray by 0.002: the mirror's laws hold to that, its tilt to the square.
// What grazing rays lose is (0.03 / sin 0.6)^2 = 0.3 % here.
TEST(SunGlint, OfACalmSeaIsAMirror) {
  const double elevation = 0.6;
  const Fresnel r = ReflectanceOfWater(std::sin(elevation));
  double intensity = 0.0;
  double across = 0.0;
  for (const GlintRay& ray : SunGlint(elevation, 2e-6)) {
    EXPECT_NEAR(ray.from.z(), -std::sin(elevation), 0.01);
    EXPECT_NEAR(ray.from.x(), std::cos(elevation), 0.01);
    intensity += ray.intensity();
    across += ray.tensor(1, 1);
  }
  EXPECT_NEAR(intensity, 0.5 * (r.s * r.s + r.p * r.p), 2e-4);
  EXPECT_NEAR(across, 0.5 * r.s * r.s, 2e-4);
}

// No facet gives back more than falls on it, whatever the waves.
TEST(SunGlint, NeverBrightens) {
  for (double elevation = 0.02; elevation < 1.57; elevation += 0.05) {
    double up = 0.0;
    for (const GlintRay& ray : SunGlint(elevation, 0.03)) up += ray.intensity() * ray.up;
    EXPECT_GT(up, 0.0);
    EXPECT_LT(up, std::sin(elevation)) << elevation;
  }
}

}  // namespace
}  // namespace polnav::sky
