#include "sim/vehicle/tyre.h"

#include <algorithm>
#include <cmath>

namespace polnav::sim {
namespace {

constexpr double kCorneringPerLoad_1_rad = 12.0;  // cornering stiffness over load
constexpr double kRelaxation_m = 0.35;
constexpr double kDamping_s = 0.03;  // of the contact spring: about a quarter of critical
constexpr double kRollingResistance = 0.012;

}  // namespace

TyreForce AdvanceTyre(const TyreInput& input, double dt_s, TyreState& state) {
  if (input.load_n <= 0.0) {
    state = {};
    return {};
  }
  const double stiffness = kCorneringPerLoad_1_rad * input.load_n / kRelaxation_m;  // [N/m]
  const double grip = input.friction * input.load_n;

  // Implicit in the relaxation: stable at any speed.
  const double before = state.left_m;
  state.left_m = (before + input.v_left_m_s * dt_s) /
                 (1.0 + std::abs(input.v_forward_m_s) * dt_s / kRelaxation_m);
  const double left_rate = (state.left_m - before) / dt_s;

  const double hold = std::min(input.brake_n + kRollingResistance * input.load_n, grip);
  const double most = hold / stiffness;
  state.forward_m = std::clamp(state.forward_m + input.v_forward_m_s * dt_s, -most, most);
  const double resisted =
      std::clamp(stiffness * (state.forward_m + kDamping_s * input.v_forward_m_s), -hold, hold);

  TyreForce force{input.drive_n - resisted, -stiffness * (state.left_m + kDamping_s * left_rate)};
  const double total = std::hypot(force.forward_n, force.left_n);
  if (total > grip) {
    const double share = grip / total;
    force.forward_n *= share;
    force.left_n *= share;
    state.left_m *= share;  // the patch slides
  }
  return force;
}

}  // namespace polnav::sim
