// Which points move otherwise than the scene?
//
// [Chu2021, eq. 12] keeps displacement vectors within L +- A. One mean L is wrong for a car that
// turns and drives forward, so each point's displacement is predicted from the expected motion and
// the point's depth. With an IMU the prediction's covariance says how large A is. Without, L is the
// median departure from the prediction (what a wrong expected rotation adds to all), and A grows
// with the predicted displacement (what a wrong expected speed adds).
#pragma once

#include <vector>

#include "nav/stereo/pose_solver.h"

namespace polnav::nav {

// expected: pose and covariance as the IMU has them; sigmas: of the pixels.
// Returns one verdict a view: true when it moves with the scene.
[[nodiscard]] std::vector<bool> MovesAsPredicted(const RectifiedCamera& camera,
                                                 const std::vector<LandmarkView>& views,
                                                 const PosePrior& expected,
                                                 const PixelSigmas& sigmas);

// T_WB_before, T_WB_expected: pose at the previous frame and the pose expected now, at constant
// velocity.
[[nodiscard]] std::vector<bool> MovesWithScene(const RectifiedCamera& camera,
                                               const std::vector<LandmarkView>& views,
                                               const Pose& T_WB_before, const Pose& T_WB_expected,
                                               double threshold_px);

}  // namespace polnav::nav
