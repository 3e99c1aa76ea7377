// How far is a keyframe's attitude from what the sky, the accelerometer and the past say?
//
// Residuals in sigmas with exact Jacobians by the pose's (dp, dtheta) in W.
#pragma once

#include <Eigen/Core>

#include "nav/api/estimate.h"
#include "nav/graph/window.h"

namespace polnav::nav {

struct HeadingResidual {
  double residual;
  Eigen::Matrix<double, 1, 6> by_pose;
};

// e4 = p_i - psi_i [Chu2021, eq. 15], wrapped. Blind to pitch and roll of a level vehicle.
[[nodiscard]] HeadingResidual EvaluateHeading(const HeadingEdge& edge, const Pose& T_WB);

struct LevelResidual {
  Eigen::Vector2d residual;
  Eigen::Matrix<double, 2, 6> by_pose;
};

// Horizontal components of the accelerometer's "up" carried into W: zero when the attitude is
// right, blind to heading.
[[nodiscard]] LevelResidual EvaluateLevel(const LevelEdge& edge, const Pose& T_WB);

// Jacobian of Log(Exp(dtheta) q q0^-1) by dtheta at zero, for theta = Log(q q0^-1).
[[nodiscard]] Eigen::Matrix3d InverseLeftJacobian(const Eigen::Vector3d& theta);

// What a vehicle that nothing is seen from may do besides going on as before: a car brakes by
// about 1 m/s and turns in by about 3 deg/s before anybody would call it a surprise.
inline constexpr double kCoastSpeedSigma_m_s = 1.0;
inline constexpr double kCoastRateSigma_rad_s = 0.05;

// A window of one pose that is known to this covariance of (dp, dtheta) in W.
[[nodiscard]] Prior PriorFromCovariance(const Pose& T_WB, const Matrix6d& covariance);

}  // namespace polnav::nav
