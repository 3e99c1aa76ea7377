// What really happened? Goes to the score and the report, never to an estimator.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "nav/api/geometry.h"
#include "nav/api/time.h"

namespace polnav::sim {

// What an IMU's readings are off by wherever it is and whatever it does: from turn-on, warming and
// wandering; not what scale, leaning axes or gravity make. In its own axes.
struct ImuBias {
  Eigen::Vector3d gyro_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_m_s2 = Eigen::Vector3d::Zero();
};

struct Truth {
  nav::TimeNs stamp = 0;
  nav::Pose T_WB;
  Eigen::Vector3d v_WB_m_s = Eigen::Vector3d::Zero();      // of B's origin, in W
  Eigen::Vector3d w_WB_B_rad_s = Eigen::Vector3d::Zero();  // of B relative to W, in B
  std::optional<ImuBias> imu_bias;                         // where an IMU's is known
};

}  // namespace polnav::sim
