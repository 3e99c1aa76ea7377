#include "sim/vehicle/hexapod/servo.h"

#include <gtest/gtest.h>

namespace polnav::sim {
namespace {

constexpr ServoOptions kServo;

TEST(Servo, PullsWithItsStallTorqueWhenFarOff) {
  EXPECT_EQ(ServoTorque(kServo, 1.0, 0.0, 0.0), kServo.stall_torque_n_m);
  EXPECT_EQ(ServoTorque(kServo, -1.0, 0.0, 0.0), -kServo.stall_torque_n_m);
}

// At the no-load speed only the gears' friction is left, and it brakes.
TEST(Servo, HasNoTorqueLeftAtItsNoLoadSpeed) {
  const double fastest = nav::DegToRad(kServo.no_load_speed_deg_s);
  EXPECT_NEAR(ServoTorque(kServo, 3.0, 0.0, fastest), -kServo.gear_friction_n_m, 1e-12);
}

TEST(Servo, IsDeafInItsDeadBand) {
  EXPECT_EQ(ServoTorque(kServo, nav::DegToRad(0.2), 0.0, 0.0), 0.0);
  EXPECT_GT(ServoTorque(kServo, nav::DegToRad(0.3), 0.0, 0.0), 0.0);
}

TEST(Servo, IsASpringUpToFullTorque) {
  const double half =
      nav::DegToRad(0.5 * kServo.full_torque_error_deg + 0.5 * kServo.dead_band_deg);
  EXPECT_NEAR(ServoTorque(kServo, half, 0.0, 0.0), 0.5 * kServo.stall_torque_n_m, 1e-12);
}

}  // namespace
}  // namespace polnav::sim
