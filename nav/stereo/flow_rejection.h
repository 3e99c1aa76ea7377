// Which points move otherwise than the scene?
//
// [Chu2021, eq. 12] keeps displacement vectors within L +- A. One mean L is wrong for a car that
// turns and drives forward, so each point's displacement is predicted from the expected motion and
// the point's depth, and A is so many sigmas of what the expectation's covariance and the pixels'
// sigmas together allow: far points show a wrong turn only, near ones a wrong speed too.
#pragma once

#include <vector>

#include "nav/stereo/pose_solver.h"

namespace polnav::nav {

// expected: by the IMU, or at constant velocity. Returns one verdict a view: true when it moves
// with the scene.
[[nodiscard]] std::vector<bool> MovesWithScene(const RectifiedCamera& camera,
                                               const std::vector<LandmarkView>& views,
                                               const PosePrior& expected, const PixelSigmas& pixels,
                                               double gate_sigmas);

}  // namespace polnav::nav
