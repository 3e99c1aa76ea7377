// Who is right when the pictures and the IMU contradict each other?
//
// Either may be wrong: an IMU sticks or its bias jumps; and points that agree with each other need
// not be of the scene (drops on the lens stand still, a bus fills half the view). What decides are
// the proven landmarks, those that two keyframes or more have seen where they should be: pictures
// and IMU agreed on them before. When nearly all of them go where the IMU says that they cannot,
// the IMU is wrong; when they do not, the pictures are, and count only as far as the proven
// landmarks go.
#pragma once

#include <optional>
#include <vector>

#include "nav/stereo/pose_solver.h"

namespace polnav::nav {

struct PoseQuestion {
  std::vector<LandmarkView> all;   // of the newest frame
  std::vector<LandmarkView> kept;  // those of them that move with the scene as the IMU expects it
  PosePrior by_imu;
};

struct PoseVerdict {
  std::optional<PoseSolution> solution;
  std::vector<LandmarkView> views;  // that the solution is of
  bool imu_wrong = false;
  bool pictures_wrong = false;
};

[[nodiscard]] PoseVerdict JudgePose(const RectifiedCamera& camera, const PoseQuestion& question,
                                    const PoseSolverOptions& options, int min_inliers);

}  // namespace polnav::nav
