// What force does the road put on a tyre?
//
// The contact patch is a spring that the rolling wheel carries away: its lateral deflection grows
// with the sideways velocity and relaxes over a relaxation length, which gives a cornering force
// proportional to the slip angle when rolling and an elastic hold at rest [Pacejka2012, ch. 7].
// Braking and rolling resistance are dry friction through the same spring [Dahl1968], so that a
// braked car on a slope stays where it is instead of creeping. The two together are bounded by the
// friction circle. Fails: no falling friction beyond the peak, no camber thrust, no wheel spin.
#pragma once

namespace polnav::sim {

// Deflection of the contact patch against the wheel [m]; zero when it was just put down.
struct TyreState {
  double forward_m = 0.0;
  double left_m = 0.0;
};

struct TyreInput {
  double load_n = 0.0;         // normal force, not negative
  double v_forward_m_s = 0.0;  // of the wheel over the ground, in the ground plane
  double v_left_m_s = 0.0;
  double drive_n = 0.0;  // forward, signed
  double brake_n = 0.0;  // most that the brake can hold, not negative
  double friction = 0.0;
};

struct TyreForce {
  double forward_n = 0.0;
  double left_n = 0.0;
};

// The force over the next dt_s, and the state after it.
[[nodiscard]] TyreForce AdvanceTyre(const TyreInput& input, double dt_s, TyreState& state);

}  // namespace polnav::sim
