// How does a car's body move over the ground when it is driven, braked and steered?
//
// Bullet's raycast vehicle: one rigid body on four massless struts, with our own tyres and rays
// into the analytic terrain (no collision mesh). One Bullet world an object, fixed step, single
// thread: the same calls give the same bytes. Bullet is used in double precision (Debian's
// bullet-float64), so that poses keep nanometres at 100 m from the origin.
// B: at the centre of mass, x forward, y left, z up; Bullet's own frame is the same here.
// Fails: no unsprung mass, no bump stops, no anti-roll bar, no aerodynamic drag; suspension forces
// act along the ground's normal.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>

#include "nav/api/geometry.h"
#include "nav/api/time.h"
#include "sim/vehicle/car_options.h"
#include "sim/world/terrain.h"

namespace polnav::sim {

class Chassis {
 public:
  static constexpr nav::TimeNs kStep = 2'000'000;
  static constexpr double kStep_s = 0.002;
  static constexpr double kGravity_m_s2 = 9.80665;

  // B's origin above start_m, leaning with the ground, at rest, the springs carrying the weight.
  // Keeps a reference to the terrain: it must outlive the chassis.
  Chassis(const CarOptions& options, const Terrain& terrain, const Eigen::Vector2d& start_m,
          double heading_rad);
  ~Chassis();
  Chassis(Chassis&&) noexcept;
  Chassis& operator=(Chassis&&) noexcept;

  struct Controls {
    double steer_rad = 0.0;  // of the middle front wheel, positive to the left
    double drive_n = 0.0;    // on the front axle, forward
    double brake_n = 0.0;    // the most that all brakes together hold
  };
  void Step(const Controls& controls);

  [[nodiscard]] nav::Pose T_WB() const;
  // Mean over the last step: difference of positions over kStep.
  [[nodiscard]] Eigen::Vector3d v_WB_m_s() const;
  // Normal force of each wheel in the last step: front left, front right, rear left, rear right.
  [[nodiscard]] std::array<double, 4> WheelLoads_n() const;
  // Kinetic, potential and of the springs, up to a constant.
  [[nodiscard]] double MechanicalEnergy_j() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polnav::sim
