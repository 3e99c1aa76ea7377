// How do a hexapod's body and legs move, when its servos pull and its feet push?
//
// Bullet's articulated body (Featherstone): a floating base and 18 revolute joints, servos as
// torques, feet as rubber spheres with friction on the analytic terrain (no collision mesh): under
// each leg lies the terrain's tangent plane at its foot. Body and knees touch the ground too, when
// the robot falls. One Bullet world an object, fixed step, single thread: the same calls give the
// same bytes.
// B: at the middle of the body's box, x forward, y left, z up.
// Fails: legs do not touch each other or the body; links are thin rods; the ground is rigid.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>

#include "nav/api/geometry.h"
#include "nav/api/time.h"
#include "sim/vehicle/hexapod/hexapod_options.h"
#include "sim/vehicle/hexapod/leg_kinematics.h"
#include "sim/world/terrain.h"

namespace polnav::sim {

using JointAngles = std::array<Eigen::Vector3d, kLegs>;  // coxa, femur, tibia [rad]

class HexapodBody {
 public:
  static constexpr nav::TimeNs kStep = 1'000'000;
  static constexpr double kStep_s = 0.001;

  // Stands at its start with its joints at these angles and its feet just on the ground. Keeps a
  // reference to the terrain: it must outlive the body.
  HexapodBody(const HexapodOptions& options, const Terrain& terrain, const JointAngles& angles);
  ~HexapodBody();
  HexapodBody(HexapodBody&&) noexcept;
  HexapodBody& operator=(HexapodBody&&) noexcept;

  // The servos are asked for these angles; push_W_n: somebody pushes the body at its middle.
  void Step(const JointAngles& wanted, const Eigen::Vector3d& push_W_n = Eigen::Vector3d::Zero());

  [[nodiscard]] nav::Pose T_WB() const;
  [[nodiscard]] Eigen::Vector3d v_WB_m_s() const;
  [[nodiscard]] JointAngles angles() const;
  [[nodiscard]] double mass_kg() const;
  // Kinetic, and potential over z = 0.
  [[nodiscard]] double MechanicalEnergy_j() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polnav::sim
