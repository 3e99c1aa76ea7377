// Which way does the turntable point?
//
// B stands still and turns about one axis, which is vertical up to a tilt drawn once a trial. It
// rests for dwell_s, turns by step_deg, and so on. Within a step of duration T the share of the
// turn done is t/T - sin(2 pi t/T) / (2 pi): rate and acceleration are continuous, and truth is in
// closed form. Not in it: wobble, backlash, flexing of the stand.
#pragma once

#include <cstdint>

#include "sim/truth.h"
#include "sim/vehicle/turntable_options.h"
#include "sim/world/terrain.h"

namespace polnav::sim {

class Turntable {
 public:
  Turntable(const TurntableOptions& options, const Terrain& terrain, std::uint64_t seed);

  void Step(nav::TimeNs step);  // truth() moves on by so much
  [[nodiscard]] const Truth& truth() const { return truth_; }

 private:
  void UpdateTruth();

  TurntableOptions options_;
  double step_s_;  // time that one step takes
  Eigen::Quaterniond q_tilt_;
  Truth truth_;
};

}  // namespace polnav::sim
