// Where is the hexapod, truly, while it walks?
//
// Driver, gait, inverse kinematics, servos, physics. It stands still for start_delay_s and walks.
// B is at the middle of the body, x forward, y left, z up.
//
// Truth is consistent with itself as the car's is: physics runs one step ahead, so that velocities
// are central differences of the very poses that are handed out.
#pragma once

#include <array>
#include <cstdint>

#include "sim/truth.h"
#include "sim/vehicle/hexapod/gait.h"
#include "sim/vehicle/hexapod/hexapod_body.h"
#include "sim/vehicle/hexapod/walk_path.h"
#include "sim/world/terrain.h"

namespace polnav::sim {

class Hexapod {
 public:
  static constexpr nav::TimeNs kStep = 2'000'000;

  // Settled on its legs at the start. Keeps a reference to the terrain. Throws std::logic_error
  // when the gait is out of the legs' reach, std::runtime_error when it does not come to rest.
  Hexapod(const HexapodOptions& options, const Terrain& terrain, std::uint64_t seed);

  void Step();  // truth() moves on by kStep
  [[nodiscard]] const Truth& truth() const { return truth_; }
  [[nodiscard]] bool finished() const { return path_.finished(); }  // there is nothing left to walk
  [[nodiscard]] const HexapodBody& body() const { return body_; }
  // Somebody pushes from now on; zero: no more.
  void Push(const Eigen::Vector3d& force_W_n) { push_W_n_ = force_W_n; }

 private:
  void Settle();
  void RunPhysics();
  void CommandServos();

  HexapodOptions options_;
  std::array<nav::Pose, kLegs> roots_;
  Gait gait_;
  WalkPath path_;
  JointAngles wanted_;
  HexapodBody body_;
  nav::TimeNs pulse_every_;
  nav::TimeNs next_pulse_ = 0;
  Eigen::Vector3d push_W_n_ = Eigen::Vector3d::Zero();
  std::array<nav::Pose, 3> poses_;  // one step before the truth, at it, and after it
  Truth truth_;
};

}  // namespace polnav::sim
