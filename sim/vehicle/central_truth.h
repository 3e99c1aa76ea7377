// What is a vehicle's truth, when its physics runs one step ahead?
//
// Velocities are central differences of the very poses that are handed out: integrating v_WB by the
// trapezoid rule gives the positions back to jerk * step^2 / 4, likewise w_WB_B.
#pragma once

#include <array>

#include "sim/sensors/rotation.h"
#include "sim/truth.h"

namespace polnav::sim {

// poses: one step before the stamp, at it, and after it.
[[nodiscard]] inline Truth CentralTruth(nav::TimeNs stamp, const std::array<nav::Pose, 3>& poses,
                                        double step_s) {
  const double span_s = 2.0 * step_s;
  return {.stamp = stamp,
          .T_WB = poses[1],
          .v_WB_m_s = (poses[2].p - poses[0].p) / span_s,
          .w_WB_B_rad_s = RotationVector(poses[0].q.conjugate() * poses[2].q) / span_s};
}

}  // namespace polnav::sim
