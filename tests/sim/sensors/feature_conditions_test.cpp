#include "sim/sensors/feature_conditions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/sim/sensors/feature_scene.h"

namespace polnav::sim {
namespace {

const RandomStream& Covers() {
  static const RandomStream stream(1, 0, "covers");
  return stream;
}

FeatureConditions Under(const CameraConditions& conditions, nav::TimeNs stamp = 0) {
  return {conditions, StereoCameraOptions{}, Covers(), stamp};
}

TEST(FeatureConditions, ACleanLensInClearAirTakesNothingAway) {
  const FeatureConditions clear = Under({});
  EXPECT_EQ(clear.ContrastShare(1.0), 1.0);
  EXPECT_EQ(clear.ContrastShare(500.0), 1.0);
  EXPECT_FALSE(clear.Saturates(1.0));
  EXPECT_FALSE(clear.IsCovered(0, {10.0, 10.0}));
}

TEST(FeatureConditions, FogLeavesTwoPercentOfTheContrastAtTheVisibility) {
  const FeatureConditions fog = Under({.visibility_m = 50.0});
  EXPECT_NEAR(fog.ContrastShare(50.0), 0.02, 1e-4);
  EXPECT_NEAR(fog.ContrastShare(25.0), std::sqrt(0.02), 1e-3);
}

// Shot noise alone: the ratio goes with the root of the light. Deep in the dark read noise wins,
// and it goes with the light itself.
TEST(FeatureConditions, DarknessLowersSignalOverNoise) {
  EXPECT_NEAR(Under({.light_share = 0.25}).ContrastShare(1.0), 0.5, 0.02);
  const double dark = Under({.light_share = 1e-4}).ContrastShare(1.0);
  EXPECT_NEAR(Under({.light_share = 1e-5}).ContrastShare(1.0), 0.1 * dark, 0.01 * dark);
  EXPECT_EQ(Under({.light_share = 0.0}).ContrastShare(1.0), 0.0);
}

// Brightness goes to 220 with a mean of 110: twelve times as much leaves a tenth below 255.
TEST(FeatureConditions, OverexposureSaturatesWhatIsBright) {
  const FeatureConditions bright = Under({.gain_share = 12.0});
  EXPECT_TRUE(bright.Saturates(0.10));
  EXPECT_FALSE(bright.Saturates(0.09));
}

// 28 x 16 squares in each eye: three sigmas of the binomial.
TEST(FeatureConditions, CoverTheirShareOfTheLensAndOnlyDropsMove) {
  const FeatureConditions dirt = Under({.dirt_share = 0.3});
  const FeatureConditions dirt_later = Under({.dirt_share = 0.3}, 9 * nav::kNsPerSecond);
  const FeatureConditions rain = Under({.rain_share = 0.3});
  const FeatureConditions rain_later = Under({.rain_share = 0.3}, 9 * nav::kNsPerSecond);
  double under_dirt = 0.0;
  double under_rain = 0.0;
  int moved = 0;
  int alike = 0;
  for (int row = 0; row < 16; ++row) {
    for (int column = 0; column < 28; ++column) {
      const Eigen::Vector2d pixel(24.0 * column + 7.0, 24.0 * row + 3.0);
      under_dirt += dirt.IsCovered(0, pixel);
      under_rain += rain.IsCovered(0, pixel);
      EXPECT_EQ(dirt.IsCovered(0, pixel), dirt_later.IsCovered(0, pixel));
      moved += rain.IsCovered(0, pixel) != rain_later.IsCovered(0, pixel);
      alike += dirt.IsCovered(0, pixel) == dirt.IsCovered(1, pixel);
    }
  }
  const double squares = 16.0 * 28.0;
  EXPECT_NEAR(under_dirt / squares, 0.3, 3.0 * std::sqrt(0.21 / squares));
  EXPECT_NEAR(under_rain / squares, 0.3, 3.0 * std::sqrt(0.21 / squares));
  EXPECT_GT(moved, 100);
  EXPECT_LT(alike, 350) << "two eyes, two lenses";
}

TEST(FeatureConditions, WhatBlindsACameraTakesItsPoints) {
  Scene scene;
  scene.meshes = {WallAt(10.0, 30.0)};
  const auto seen = [&](const CameraConditions& conditions) {
    FeatureRig rig(scene);
    return rig.Next({}, conditions).sightings.size();
  };
  const std::size_t clear = seen({});
  EXPECT_GT(clear, 250U);
  EXPECT_LT(seen({.visibility_m = 15.0}), clear / 4) << "exp(-2.6) of the reach at 10 m";
  EXPECT_LT(seen({.light_share = 0.01}), clear / 4);
  EXPECT_LT(seen({.gain_share = 12.0}), clear / 2);
  EXPECT_LT(seen({.glare = 5.0}), clear / 2);
  EXPECT_EQ(seen({.dirt_share = 1.0}), 0U);
}

}  // namespace
}  // namespace polnav::sim
