// What does the IMU say about two keyframes, and where does it say that a frame is?
//
// Residuals in sigmas with exact Jacobians, those of poses by (dp, dtheta) in W, those of motions
// by (dv, dgyro_bias, daccel_bias). Rows: attitude (3), velocity (3), position (3), bias walk (6).
#pragma once

#include <Eigen/Core>

#include "nav/api/estimate.h"
#include "nav/inertial/preintegration.h"

namespace polnav::nav {

using Vector15d = Eigen::Matrix<double, 15, 1>;
using Matrix15x6d = Eigen::Matrix<double, 15, 6>;
using Matrix15x9d = Eigen::Matrix<double, 15, 9>;
using Matrix15d = Eigen::Matrix<double, 15, 15>;

// From the keyframe before to this one.
struct InertialEdge {
  Preintegration sum;
  Pose T_BI;
  Matrix9d weight = Matrix9d::Zero();  // lower triangular square root of the information
  double gyro_walk_weight = 0.0;       // one over sigma
  double accel_walk_weight = 0.0;
  bool settled = false;  // level and velocity were known where it begins
};

// What a bias may change by from one keyframe to the next, one sigma.
struct BiasWalk {
  double gyro_rad_s = 0.0;
  double accel_m_s2 = 0.0;
};

[[nodiscard]] InertialEdge MakeInertialEdge(const Preintegration& sum, const BiasWalk& walk,
                                            const Pose& T_BI);

struct InertialResidual {
  Vector15d residual;
  Matrix15x6d by_pose_i;
  Matrix15x9d by_motion_i;
  Matrix15x6d by_pose_j;
  Matrix15x9d by_motion_j;
};

[[nodiscard]] InertialResidual EvaluateInertial(const InertialEdge& edge, const Pose& T_WBi,
                                                const Motion& motion_i, const Pose& T_WBj,
                                                const Motion& motion_j);

// A frame after a keyframe, as the IMU has it.
struct InertialPrediction {
  Pose T_WB;
  Eigen::Vector3d v_WI;
  Matrix9d covariance;  // of (dp, dtheta, dv) in W, relative to the keyframe
};

// state_covariance: of the keyframe's (dp, dtheta, dv, dgyro_bias, daccel_bias). What the frame
// shares with the keyframe, its position and attitude error as such, is not in the answer; what a
// tilted gravity makes of it is.
[[nodiscard]] InertialPrediction Predict(const Preintegration& sum, const Pose& T_BI,
                                         const Pose& T_WBi, const Motion& motion_i,
                                         const Matrix15d& state_covariance);

}  // namespace polnav::nav
