// Where should the feet be, so that the body moves as commanded?
//
// A tripod gait in the plane of B. Feet on the ground move against the body's motion; feet in the
// air go to where they will stand half a stance ahead of their resting place, on a smooth arc.
// Commands may change at any time: feet on the ground integrate them. Steps end when nothing is
// commanded and all feet are at rest. The robot walks blind: the gait knows nothing of the ground.
#pragma once

#include <Eigen/Core>
#include <array>

#include "sim/vehicle/hexapod/hexapod_options.h"
#include "sim/vehicle/hexapod/leg_kinematics.h"

namespace polnav::sim {

struct WalkCommand {
  Eigen::Vector2d v_B_m_s = Eigen::Vector2d::Zero();
  double turn_rate_rad_s = 0.0;  // counterclockwise
};

using Feet = std::array<Eigen::Vector3d, kLegs>;  // in B [m]

class Gait {
 public:
  explicit Gait(const HexapodOptions& options);

  void Step(const WalkCommand& command, double dt_s);
  [[nodiscard]] const Feet& feet_B_m() const { return feet_; }
  [[nodiscard]] bool standing() const { return standing_; }

 private:
  [[nodiscard]] double PhaseOf(int leg) const;
  void Stand(int leg, const WalkCommand& command, double dt_s);
  void Swing(int leg, double share, const WalkCommand& command);
  [[nodiscard]] bool AtRest() const;

  GaitOptions options_;
  Feet rest_;
  Feet feet_;
  Feet lifted_from_;
  std::array<bool, kLegs> swings_{};
  double phase_ = 0.0;  // of the first tripod, in [0, 1); its swing comes first
  bool standing_ = true;
};

// Every place that the feet go to at this speed ahead and this turn rate, in turn and together, is
// within the legs' reach.
[[nodiscard]] bool IsWithinReach(const HexapodOptions& options, double speed_m_s,
                                 double turn_rate_rad_s);

}  // namespace polnav::sim
