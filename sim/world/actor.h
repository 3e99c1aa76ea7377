// Where is an actor at an instant?
//
// Between the keys of its path position is a Catmull-Rom spline and attitude goes the shortest way;
// before the first and after the last key the actor is not there.
#pragma once

#include <optional>
#include <vector>

#include "nav/api/geometry.h"
#include "nav/api/time.h"
#include "sim/world/scene.h"

namespace polnav::sim {

// T_WA, or nothing when the actor is not there.
[[nodiscard]] std::optional<nav::Pose> PoseOf(const std::vector<ActorKey>& path, nav::TimeNs stamp);

}  // namespace polnav::sim
