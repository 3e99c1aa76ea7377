// What turntable is it, and how does it turn? YAML keys = field names.
#pragma once

#include <Eigen/Core>

namespace polnav::sim {

// The defaults are the motion of Chu2021's experiment A: stops of 30 s at every 90 degrees.
struct TurntableOptions {
  Eigen::Vector3d position_m = {0.0, 0.0, 1.0};  // of B: east, north, above the ground
  double start_heading_deg = 0.0;
  double step_deg = 90.0;         // from stop to stop, clockwise; negative turns back
  double dwell_s = 30.0;          // at every stop, before the first step too
  double peak_rate_deg_s = 10.0;  // half way through a step; the mean is half of it
  double tilt_sigma_deg = 0.05;   // of its axis off the vertical, each way; stays for the trial

  bool operator==(const TurntableOptions&) const = default;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("position_m", position_m, {.min = -1e4, .max = 1e4});
    v("start_heading_deg", start_heading_deg, {.min = -360.0, .max = 360.0});
    v("step_deg", step_deg, {.min = -360.0, .max = 360.0});
    v("dwell_s", dwell_s, {.min = 0.0, .max = 86400.0});
    v("peak_rate_deg_s", peak_rate_deg_s, {.min = 0.001, .max = 1000.0});
    v("tilt_sigma_deg", tilt_sigma_deg, {.min = 0.0, .max = 45.0});
  }
};

}  // namespace polnav::sim
