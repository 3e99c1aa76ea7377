// What does the driver do?
//
// Steering: the rear axle follows the centre line plus a smooth weave. For it heading is course, so
// that per metre driven the offset's rate is the heading error, and the heading's is tan(steer) /
// wheelbase: curvature feed-forward plus state feedback with one length scale. Speed: a
// jerk-limited reference, followed by PI; then brakes to rest after the last lap. Fails: at the
// tyres' limits; it neither foresees slip nor slows down in bends.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "nav/api/geometry.h"
#include "sim/vehicle/car_options.h"
#include "sim/vehicle/chassis.h"
#include "sim/world/track.h"

namespace polnav::sim {

class PathFollower {
 public:
  // Keeps a reference to the track: it must outlive the follower.
  PathFollower(const CarOptions& options, const Track& track, std::uint64_t seed);

  // Foot on the brake, wheels straight.
  [[nodiscard]] Chassis::Controls Hold() const;
  // One step of Chassis::kStep.
  [[nodiscard]] Chassis::Controls Drive(const nav::Pose& T_WB, const Eigen::Vector3d& v_WB_m_s);

  // Arc length that the car's middle has come along the centre line.
  [[nodiscard]] double progress_m() const;
  [[nodiscard]] bool finished() const;  // all laps driven

 private:
  struct Weave {
    double offset_m, slope, curvature_1_m;
  };
  struct Wave {
    double k_rad_m, phase_rad, amplitude_m;
  };
  [[nodiscard]] Weave WeaveAt(double s_m) const;
  [[nodiscard]] double Steer(const nav::Pose& T_WB, double speed_m_s);
  [[nodiscard]] double Accelerate(double speed_m_s);

  CarOptions options_;
  const Track* track_;
  std::vector<Wave> waves_;
  double rear_s_m_ = 0.0;  // arc length of the rear axle, not wrapped at a lap
  double steer_rad_ = 0.0;
  double reference_m_s_ = 0.0;
  double reference_m_s2_ = 0.0;
  double speed_error_m_ = 0.0;  // integral
  double force_n_ = 0.0;        // pedals move at a finite rate: forward drive, backward brake
  bool stopped_ = false;
};

}  // namespace polnav::sim
