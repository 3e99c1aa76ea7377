// Where is the car, truly, while it drives its laps?
//
// A chassis and a driver. It stands still for start_delay_s, drives the laps, brakes to rest and
// stays. B is at the centre of mass, x forward, y left, z up.
//
// Truth is consistent with itself: physics runs one step ahead, so that velocities are central
// differences of the very poses that are handed out. Integrating v_WB by the trapezoid rule gives
// the positions back to jerk * step^2 / 4, a few micrometres per second; likewise w_WB_B.
#pragma once

#include <array>
#include <cstdint>

#include "sim/truth.h"
#include "sim/vehicle/car_options.h"
#include "sim/vehicle/chassis.h"
#include "sim/vehicle/path_follower.h"
#include "sim/world/terrain.h"
#include "sim/world/track.h"

namespace polnav::sim {

class Car {
 public:
  static constexpr nav::TimeNs kStep = Chassis::kStep;

  // At the start of the track, settled on its springs. Keeps references to track and terrain.
  Car(const CarOptions& options, const Track& track, const Terrain& terrain, std::uint64_t seed);

  void Step();  // truth() moves on by kStep
  [[nodiscard]] const Truth& truth() const { return truth_; }
  [[nodiscard]] bool finished() const { return driver_.finished(); }  // all laps driven
  [[nodiscard]] double progress_m() const { return driver_.progress_m(); }

 private:
  void Settle();
  void RunPhysics();

  CarOptions options_;
  Chassis chassis_;
  PathFollower driver_;
  nav::TimeNs start_;
  std::array<nav::Pose, 3> poses_;  // one step before the truth, at it, and after it
  Truth truth_;
};

}  // namespace polnav::sim
