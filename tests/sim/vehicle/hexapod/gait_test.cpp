#include "sim/vehicle/hexapod/gait.h"

#include <gtest/gtest.h>

namespace polnav::sim {
namespace {

constexpr double kStep_s = 0.002;
constexpr double kOnGround_m = 1e-9;
const HexapodOptions kHexapod;

int FeetDown(const Gait& gait) {
  int down = 0;
  for (const Eigen::Vector3d& foot : gait.feet_B_m()) {
    down += foot.z() < -kHexapod.gait.body_height_m + kOnGround_m ? 1 : 0;
  }
  return down;
}

TEST(Gait, StandsWhileNothingIsCommanded) {
  Gait gait(kHexapod);
  const Feet before = gait.feet_B_m();
  for (int k = 0; k < 1000; ++k) gait.Step({}, kStep_s);
  EXPECT_TRUE(gait.standing());
  EXPECT_EQ(gait.feet_B_m(), before);
}

// Feet down do not slide over the ground: their velocity in B is the body's, reversed.
TEST(Gait, FeetOnTheGroundCarryTheBodyAsCommanded) {
  Gait gait(kHexapod);
  const WalkCommand command{{0.1, 0.02}, 0.3};
  const auto is_down = [](const Eigen::Vector3d& foot) {
    return foot.z() < -kHexapod.gait.body_height_m + kOnGround_m;
  };
  Feet before = gait.feet_B_m();
  gait.Step(command, kStep_s);
  for (int k = 0; k < 2000; ++k) {
    const Feet now = gait.feet_B_m();
    gait.Step(command, kStep_s);
    EXPECT_GE(FeetDown(gait), 3);
    for (int i = 0; i < kLegs; ++i) {
      // A foot that is about to be raised rests for one step.
      if (!is_down(before[i]) || !is_down(now[i]) || !is_down(gait.feet_B_m()[i])) continue;
      const Eigen::Vector3d moved = now[i] - before[i];
      EXPECT_NEAR(moved.x(), -kStep_s * (0.1 - 0.3 * before[i].y()), 1e-12);
      EXPECT_NEAR(moved.y(), -kStep_s * (0.02 + 0.3 * before[i].x()), 1e-12);
    }
    before = now;
  }
}

TEST(Gait, FeetAreRaisedByTheLift) {
  Gait gait(kHexapod);
  double highest = -1.0;
  for (int k = 0; k < 1000; ++k) {
    gait.Step({{0.1, 0.0}, 0.0}, kStep_s);
    for (const Eigen::Vector3d& foot : gait.feet_B_m()) highest = std::max(highest, foot.z());
  }
  // The top is met to within the square of half a step's phase.
  EXPECT_NEAR(highest, -kHexapod.gait.body_height_m + kHexapod.gait.lift_m, 1e-5);
}

TEST(Gait, ComesToStandWhenToldToStop) {
  Gait gait(kHexapod);
  for (int k = 0; k < 777; ++k) gait.Step({{0.1, 0.0}, -0.2}, kStep_s);
  EXPECT_FALSE(gait.standing());
  // Every foot is put to its place within one swing of each tripod.
  for (int k = 0; k < 2.0 * kHexapod.gait.cycle_s / kStep_s; ++k) gait.Step({}, kStep_s);
  EXPECT_TRUE(gait.standing());
}

TEST(Gait, ReachIsLimited) {
  EXPECT_TRUE(IsWithinReach(kHexapod, 0.12, 0.4));
  EXPECT_FALSE(IsWithinReach(kHexapod, 0.6, 0.0)) << "steps of a third of a metre";
  HexapodOptions high = kHexapod;
  high.gait.body_height_m = 0.18;
  EXPECT_FALSE(IsWithinReach(high, 0.0, 0.0)) << "higher than its legs are long";
}

}  // namespace
}  // namespace polnav::sim
