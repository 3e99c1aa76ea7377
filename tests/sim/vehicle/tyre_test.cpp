#include "sim/vehicle/tyre.h"

#include <gtest/gtest.h>

#include <cmath>

namespace polnav::sim {
namespace {

constexpr double kDt_s = 0.002;
constexpr double kLoad_n = 3000.0;

TyreForce AfterSteps(TyreInput input, int steps) {
  TyreState state;
  TyreForce force;
  for (int i = 0; i < steps; ++i) force = AdvanceTyre(input, kDt_s, state);
  return force;
}

// 12 per radian of load; after 3 m, nine relaxation lengths, exp(-9) = 1e-4 of it is missing.
TEST(Tyre, CornersInProportionToTheSlipAngleWhenRolling) {
  for (const double speed : {3.0, 6.0, -6.0}) {
    const TyreInput input{.load_n = kLoad_n,
                          .v_forward_m_s = speed,
                          .v_left_m_s = 0.01 * std::abs(speed),
                          .friction = 0.9};
    const TyreForce force = AfterSteps(input, static_cast<int>(3.0 / std::abs(speed) / kDt_s));
    EXPECT_NEAR(force.left_n, -12.0 * kLoad_n * 0.01, 0.2) << speed;
  }
}

TEST(Tyre, NeverPullsHarderThanTheFrictionCircle) {
  TyreState state;
  for (int i = 0; i < 1000; ++i) {
    const TyreInput input{.load_n = kLoad_n,
                          .v_forward_m_s = 6.0,
                          .v_left_m_s = 3.0 * std::sin(0.01 * i),
                          .drive_n = 2500.0,
                          .brake_n = i % 300 < 150 ? 0.0 : 5000.0,
                          .friction = 0.9};
    const TyreForce force = AdvanceTyre(input, kDt_s, state);
    EXPECT_LE(std::hypot(force.forward_n, force.left_n), 0.9 * kLoad_n * (1.0 + 1e-12));
  }
}

TEST(Tyre, BrakesAgainstTheMotionWithTheBrakesForceAndRollingResistance) {
  for (const double speed : {5.0, -5.0}) {
    const TyreForce force = AfterSteps(
        {.load_n = kLoad_n, .v_forward_m_s = speed, .brake_n = 1000.0, .friction = 0.9}, 500);
    EXPECT_NEAR(force.forward_n, -std::copysign(1000.0 + 0.012 * kLoad_n, speed), 1e-9);
  }
}

// Pushed aside by d and then left alone, it pulls back with the spring's force for ever: no creep.
TEST(Tyre, HoldsElasticallyAtRest) {
  TyreState state;
  const double d = 1e-4;
  for (int i = 0; i < 50; ++i) {
    (void)AdvanceTyre({.load_n = kLoad_n, .v_left_m_s = d / 0.1, .friction = 0.9}, kDt_s, state);
  }
  const TyreInput at_rest{.load_n = kLoad_n, .friction = 0.9};
  const TyreForce early = AdvanceTyre(at_rest, kDt_s, state);
  TyreForce late;
  for (int i = 0; i < 10000; ++i) late = AdvanceTyre(at_rest, kDt_s, state);
  EXPECT_NEAR(early.left_n, -12.0 * kLoad_n / 0.35 * d, 1e-6);
  EXPECT_EQ(late.left_n, early.left_n);
}

TEST(Tyre, LosesItsDeflectionInTheAir) {
  TyreState state{.forward_m = 0.01, .left_m = 0.02};
  const TyreForce force = AdvanceTyre({.load_n = 0.0, .v_left_m_s = 1.0}, kDt_s, state);
  EXPECT_EQ(force.left_n, 0.0);
  EXPECT_EQ(force.forward_n, 0.0);
  EXPECT_EQ(state.left_m, 0.0);
}

}  // namespace
}  // namespace polnav::sim
