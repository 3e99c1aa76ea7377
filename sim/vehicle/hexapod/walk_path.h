// What does the hexapod's driver command?
//
// Speed ahead and turn rate, smoothed, from where the robot truly is: a square is walked until its
// corners are reached. wander: sums of sines of many periods, drawn from the seed; far from the
// start the robot is turned back.
#pragma once

#include <cstdint>
#include <vector>

#include "nav/api/geometry.h"
#include "sim/vehicle/hexapod/gait.h"
#include "sim/vehicle/hexapod/hexapod_options.h"

namespace polnav::sim {

class WalkPath {
 public:
  WalkPath(const HexapodOptions& options, std::uint64_t seed);

  // t_s: since the vehicle's start, delay included.
  [[nodiscard]] WalkCommand Command(double t_s, const nav::Pose& T_WB, double dt_s);
  [[nodiscard]] bool finished() const { return leg_ >= static_cast<int>(corners_.size()); }

 private:
  struct Wave {
    double w_rad_s, phase_rad, amplitude;
  };
  struct Wanted {
    double speed_m_s = 0.0;
    double turn_rate_rad_s = 0.0;
  };
  [[nodiscard]] Wanted Wander(double t_s, const nav::Pose& T_WB) const;
  [[nodiscard]] Wanted ToCorners(const nav::Pose& T_WB);
  [[nodiscard]] static std::vector<Wave> DrawWaves(std::uint64_t seed, const char* stream);

  WalkOptions options_;
  Eigen::Vector2d start_m_;
  std::vector<Wave> speed_waves_;
  std::vector<Wave> turn_waves_;
  // Where to walk in turn, and the heading to take up there before going on (counterclockwise from
  // east).
  struct Corner {
    Eigen::Vector2d p_m;
    double course_rad;
  };
  std::vector<Corner> corners_;
  int leg_ = 0;
  bool turning_ = false;  // on the spot, at the end of this leg
  Wanted given_;
};

}  // namespace polnav::sim
