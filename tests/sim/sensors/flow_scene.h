// A sensor without errors over level ground, and motions of it that are known.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "sim/sensors/flow_interval.h"
#include "sim/sensors/optical_flow.h"
#include "sim/world/world.h"

namespace polnav::sim {

inline OpticalFlowOptions PerfectFlow() {
  OpticalFlowOptions o;
  o.position_m = Eigen::Vector3d::Zero();
  o.full_well_e = 1e7;
  o.read_noise_e = 0.0;
  o.focal_sigma = o.mount_error_sigma_deg = 0.0;
  o.gyro_noise_deg_s_sqrt_hz = o.gyro_bias_sigma_deg_s = o.gyro_scale_sigma = 0.0;
  o.range_sigma_m = o.range_bias_sigma_m = o.range_scale_sigma = 0.0;
  o.range_dropout_probability = 0.0;
  o.model.noise_sigma_px = 0.0;
  return o;
}

inline WorldOptions LevelWorld() {
  WorldOptions world;
  world.terrain = {.slope_deg = 0.0, .camber_deg = 0.0, .undulation_m = 0.0, .bump_m = 0.0};
  return world;
}

struct LevelGround {
  LevelGround() : track(LevelWorld().track), terrain(LevelWorld().terrain, track, 1) {}
  Track track;
  Terrain terrain;
};

// Constant velocity (W) and turn rate (B) from a pose: what is felt t seconds later.
struct GlideMotion {
  nav::Pose start;
  Eigen::Vector3d v_W_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_B_rad_s = Eigen::Vector3d::Zero();

  [[nodiscard]] Truth At(nav::TimeNs stamp) const {
    const double t_s = nav::ToSeconds(stamp);
    Truth truth{.stamp = stamp, .T_WB = start, .v_WB_m_s = v_W_m_s, .w_WB_B_rad_s = w_B_rad_s};
    truth.T_WB.p += t_s * v_W_m_s;
    const double rate = w_B_rad_s.norm();
    if (rate > 0.0) {
      truth.T_WB.q = start.q * Eigen::Quaterniond(Eigen::AngleAxisd(rate * t_s, w_B_rad_s / rate));
    }
    return truth;
  }
};

inline std::vector<FlowInterval> Intervals(OpticalFlow& flow, const GlideMotion& motion, int count,
                                           nav::TimeNs period = 4'000'000) {
  std::vector<FlowInterval> intervals;
  for (nav::TimeNs k = 0; static_cast<int>(intervals.size()) < count; ++k) {
    if (auto interval = flow.Look(motion.At(k * period))) intervals.push_back(*interval);
  }
  return intervals;
}

}  // namespace polnav::sim
