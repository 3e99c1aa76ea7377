#include "sim/vehicle/hexapod/gait.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace polnav::sim {
namespace {

constexpr double kAtRest_m = 1e-3;  // as near as a foot must be to its place, to stand
constexpr double kNoSpeed_m_s = 1e-4;

// Velocity over the ground of the body's point p.
Eigen::Vector3d VelocityAt(const WalkCommand& command, const Eigen::Vector3d& p_B) {
  return {command.v_B_m_s.x() - command.turn_rate_rad_s * p_B.y(),
          command.v_B_m_s.y() + command.turn_rate_rad_s * p_B.x(), 0.0};
}

// From 0 to 1 with no speed at both ends.
double Smooth(double s) {
  return s - std::sin(2.0 * std::numbers::pi * s) / (2.0 * std::numbers::pi);
}

}  // namespace

Gait::Gait(const HexapodOptions& options) : options_(options.gait) {
  const auto roots = LegRoots(options);
  for (int i = 0; i < kLegs; ++i) {
    rest_[i] = roots[i] * Eigen::Vector3d(options_.reach_m, 0.0, -options_.body_height_m);
  }
  feet_ = rest_;
  lifted_from_ = rest_;
}

double Gait::PhaseOf(int leg) const {
  const double phase = phase_ + (leg % 2 == 0 ? 0.0 : 0.5);
  return phase - std::floor(phase);
}

bool Gait::AtRest() const {
  for (int i = 0; i < kLegs; ++i) {
    if ((feet_[i] - rest_[i]).norm() > kAtRest_m) return false;
  }
  return true;
}

void Gait::Step(const WalkCommand& command, double dt_s) {
  const bool moves = command.v_B_m_s.norm() > kNoSpeed_m_s ||
                     std::abs(command.turn_rate_rad_s) * options_.reach_m > kNoSpeed_m_s;
  if (standing_ && !moves) return;
  if (standing_) phase_ = 0.0;
  standing_ = false;
  phase_ += dt_s / options_.cycle_s;
  phase_ -= std::floor(phase_);
  for (int i = 0; i < kLegs; ++i) {
    const double phase = PhaseOf(i);
    if (phase < options_.swing_share) {
      Swing(i, phase / options_.swing_share, command);
    } else {
      Stand(i, command, dt_s);
    }
  }
  standing_ = !moves && AtRest();
}

void Gait::Stand(int leg, const WalkCommand& command, double dt_s) {
  swings_[leg] = false;
  feet_[leg] -= dt_s * VelocityAt(command, feet_[leg]);
  feet_[leg].z() = rest_[leg].z();
}

void Gait::Swing(int leg, double share, const WalkCommand& command) {
  if (!swings_[leg]) lifted_from_[leg] = feet_[leg];
  swings_[leg] = true;
  const double half_stance_s = 0.5 * (1.0 - options_.swing_share) * options_.cycle_s;
  const Eigen::Vector3d goal = rest_[leg] + half_stance_s * VelocityAt(command, rest_[leg]);
  feet_[leg] = lifted_from_[leg] + Smooth(share) * (goal - lifted_from_[leg]);
  // Up and down again, with no speed at either end.
  feet_[leg].z() =
      rest_[leg].z() + 0.5 * options_.lift_m * (1.0 - std::cos(2.0 * std::numbers::pi * share));
}

bool IsWithinReach(const HexapodOptions& options, double speed_m_s, double turn_rate_rad_s) {
  constexpr double kStep_s = 0.01;
  const auto roots = LegRoots(options);
  for (const WalkCommand& command :
       {WalkCommand{{speed_m_s, 0.0}, 0.0}, WalkCommand{{0.0, 0.0}, turn_rate_rad_s},
        WalkCommand{{0.0, 0.0}, -turn_rate_rad_s}, WalkCommand{{speed_m_s, 0.0}, turn_rate_rad_s},
        WalkCommand{{speed_m_s, 0.0}, -turn_rate_rad_s}}) {
    Gait gait(options);
    const int steps = static_cast<int>(std::ceil(2.0 * options.gait.cycle_s / kStep_s));
    for (int k = 0; k <= steps; ++k) {
      for (int i = 0; i < kLegs; ++i) {
        if (!AnglesFor(options.leg, roots[i].Inverse() * gait.feet_B_m()[i])) return false;
      }
      gait.Step(command, kStep_s);
    }
  }
  return true;
}

}  // namespace polnav::sim
