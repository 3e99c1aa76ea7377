// What do an optical-flow camera and a range finder read above a ground that may rise and fall?
//
//   F     z along the optical axis, down; flow and its signs: nav/api/measurements.h
//   range d = (height of F above the ground below) / (downward part of F's z axis)
//   flow  (w_x - v_y / d, w_y + v_x / d), means over the interval; v of F, so with the lever arm.
//         What the turn makes of it and what the walk makes of it err differently: the one by
//         1 + flow_turn, as gyroscopes and camera differ in scale and axes, which the steps' swing
//         shows within seconds; the other by 1 + flow_scale, turned by flow_yaw, which nothing
//         shows
// Curved along pitch and roll, and for the flow along the height; linear along all others. A slope
// of the ground is noise. Fails where the ground is no ground: steps, edges, grass that moves.
#pragma once

#include "nav/api/calibration.h"
#include "nav/api/measurements.h"
#include "nav/ukf/correct.h"
#include "nav/ukf/options.h"

namespace polnav::nav::ukf {

struct GroundSensor {
  Pose T_IF;
  OpticalFlowCalibration calibration;
};

// The interval of a flow reading, as the IMU has it.
struct FlowInterval {
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();  // mean, as read by the gyroscopes
  // Velocity at the end less the mean one, in W.
  Eigen::Vector3d gained_m_s = Eigen::Vector3d::Zero();
  double duration_s = 0.0;
};

// Of the state moved by an error.
[[nodiscard]] double RangeOf(const State& state, const GroundSensor& sensor, const Error& error);
[[nodiscard]] Eigen::Vector2d FlowOf(const State& state, const GroundSensor& sensor,
                                     const FlowInterval& interval, const Error& error);

[[nodiscard]] Expected<1> ExpectRange(const State& state, const GroundSensor& sensor);
[[nodiscard]] Expected<2> ExpectFlow(const State& state, const GroundSensor& sensor,
                                     const FlowInterval& interval);

// Variances of a reading's own errors.
[[nodiscard]] double RangeNoise(const State& state, const GroundSensor& sensor,
                                const UkfOptions& options);
[[nodiscard]] double FlowNoise(const State& state, const GroundSensor& sensor,
                               const FlowInterval& interval, double integration_s,
                               const UkfOptions& options);

// The height above the ground is known well enough for flow to be a velocity.
[[nodiscard]] bool KnowsHeight(const State& state, const GroundSensor& sensor);

}  // namespace polnav::nav::ukf
