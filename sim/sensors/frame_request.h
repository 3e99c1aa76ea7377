// Which picture is to be taken? Everything it depends on besides the world and the camera.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "nav/api/geometry.h"
#include "nav/api/time.h"
#include "sim/sensors/camera_conditions.h"

namespace polnav::sim {

struct FrameRequest {
  nav::TimeNs stamp = 0;    // the middle of the exposure (of the middle row)
  std::uint64_t index = 0;  // of the frame, for the noise
  nav::Pose T_WB;           // at the stamp
  // How the vehicle moves about the stamp, for blur and rolling shutter; see sim/truth.h.
  Eigen::Vector3d v_WB_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_WB_B_rad_s = Eigen::Vector3d::Zero();
  CameraConditions conditions;
  // Grey value per radiance of the clear zenith, over 255; zero: the camera's own fixed one.
  double exposure = 0.0;
};

// The ground truth of a picture, which needs to know where the next one is taken.
struct FrameTruthRequest {
  FrameRequest frame;
  nav::TimeNs next_stamp = 0;
  nav::Pose next_T_WB;
};

}  // namespace polnav::sim
