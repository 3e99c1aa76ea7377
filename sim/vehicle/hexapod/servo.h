// How hard does a position servo pull?
//
// Its electronics drive a DC motor by a voltage in proportion to the missing angle, up to the full
// one; the motor's own rotation takes from the voltage:
//   torque = stall (u - rate / no-load speed), u = missing angle / full_torque_error in [-1, 1]
// less the gears' friction, never beyond the stall torque. Not in it: backlash, heating, a battery
// that sags.
#pragma once

#include <algorithm>
#include <cmath>

#include "nav/api/geometry.h"
#include "sim/vehicle/hexapod/hexapod_options.h"

namespace polnav::sim {

// [N m], along the joint's positive sense.
[[nodiscard]] inline double ServoTorque(const ServoOptions& servo, double wanted_rad,
                                        double angle_rad, double rate_rad_s) {
  // Dry friction is smoothed over this rate: what creeps slower is held by the motor anyway.
  constexpr double kCreep_rad_s = 0.1;
  const double missing = wanted_rad - angle_rad;
  const double half_band = 0.5 * nav::DegToRad(servo.dead_band_deg);
  const double felt = missing - std::clamp(missing, -half_band, half_band);
  const double drive = std::clamp(felt / nav::DegToRad(servo.full_torque_error_deg), -1.0, 1.0);
  const double torque =
      servo.stall_torque_n_m * (drive - rate_rad_s / nav::DegToRad(servo.no_load_speed_deg_s)) -
      servo.gear_friction_n_m * std::tanh(rate_rad_s / kCreep_rad_s);
  return std::clamp(torque, -servo.stall_torque_n_m, servo.stall_torque_n_m);
}

}  // namespace polnav::sim
