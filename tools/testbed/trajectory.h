// Where was the vehicle, when? Poses T_WB in order of time, of the truth or of an estimator.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <iterator>
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

// What is further apart in time does not belong together.
inline constexpr nav::TimeNs kTogether = 10'000'000;

// The one of the nearest stamp, the earlier of two equally near (numpy's argmin takes the first).
// In order of time. Null when none is within max_difference.
template <typename Stamped>
[[nodiscard]] const Stamped* NearestWithin(const std::vector<Stamped>& series, nav::TimeNs stamp,
                                           nav::TimeNs max_difference) {
  auto at = std::lower_bound(series.begin(), series.end(), stamp,
                             [](const Stamped& s, nav::TimeNs t) { return s.stamp < t; });
  if (at != series.begin() &&
      (at == series.end() || stamp - std::prev(at)->stamp <= at->stamp - stamp)) {
    --at;
  }
  if (at == series.end() || std::abs(at->stamp - stamp) > max_difference) return nullptr;
  return &*at;
}

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
