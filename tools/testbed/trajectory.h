// Where was the vehicle, when? Poses T_WB in order of time, of the truth or of an estimator.
#pragma once

#include <vector>

#include "nav/api/estimate.h"
#include "nav/api/geometry.h"
#include "nav/api/time.h"
#include "sim/truth.h"

namespace polnav::testbed {

struct StampedPose {
  nav::TimeNs stamp = 0;
  nav::Pose T_WB;
};

using Trajectory = std::vector<StampedPose>;

[[nodiscard]] inline Trajectory TrajectoryOf(const std::vector<nav::Estimate>& estimates) {
  Trajectory trajectory;
  trajectory.reserve(estimates.size());
  for (const nav::Estimate& e : estimates) trajectory.push_back({e.stamp, e.T_WB});
  return trajectory;
}

[[nodiscard]] inline Trajectory TrajectoryOf(const std::vector<sim::Truth>& truth) {
  Trajectory trajectory;
  trajectory.reserve(truth.size());
  for (const sim::Truth& t : truth) trajectory.push_back({t.stamp, t.T_WB});
  return trajectory;
}

}  // namespace polnav::testbed
