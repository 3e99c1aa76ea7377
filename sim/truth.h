// What really happened? Goes to the score and the report, never to an estimator.
#pragma once

#include <Eigen/Core>

#include "nav/api/geometry.h"
#include "nav/api/time.h"

namespace polnav::sim {

struct Truth {
  nav::TimeNs stamp = 0;
  nav::Pose T_WB;
  Eigen::Vector3d v_WB_m_s = Eigen::Vector3d::Zero();      // of B's origin, in W
  Eigen::Vector3d w_WB_B_rad_s = Eigen::Vector3d::Zero();  // of B relative to W, in B
};

}  // namespace polnav::sim
