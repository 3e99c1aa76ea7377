// What remains of a keyframe that leaves the window, and how sure is the newest one?
//
// Both questions are answered from the window's normal equations with the landmarks eliminated
// (Schur complement). A prior is linearized where it was made and stays so; the other edges are
// linearized afresh, so the window's absolute yaw and position can gain a little information that
// is not there. The effect is bounded by the estimate's change within one window's length.
#pragma once

#include <Eigen/Core>

#include "nav/api/estimate.h"
#include "nav/graph/bundle_adjustment.h"

namespace polnav::nav {

// Turns the oldest keyframe, with the landmarks it hosts and all their sightings, into a prior on
// the others. A track that is still seen afterwards begins a new landmark: no sighting counts
// twice.
void MarginalizeOldest(const RectifiedCamera& camera, const BundleAdjustmentOptions& options,
                       Window& window);

// Of the newest keyframe's pose and motion in W, and of the sky's errors.
[[nodiscard]] StateCovariance NewestCovariance(const NormalEquations& window);

}  // namespace polnav::nav
