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
  Eigen::Matrix<double, 1, kSkyErrors> by_errors;
};

// e4 = p_i - psi_i [Chu2021, eq. 15], wrapped, and what a tilt and the instrument make of p_i.
[[nodiscard]] HeadingResidual EvaluateHeading(const HeadingEdge& edge, const Pose& T_WB,
                                              const SkyErrors& errors = SkyErrors::Zero());

struct LevelResidual {
  Eigen::Vector2d residual;
  Eigen::Matrix<double, 2, 6> by_pose;
};

// Horizontal components of the accelerometer's "up" carried into W: zero when the attitude is
// right, blind to heading.
[[nodiscard]] LevelResidual EvaluateLevel(const LevelEdge& edge, const Pose& T_WB);

// Jacobian of Log(Exp(dtheta) q q0^-1) by dtheta at zero, for theta = Log(q q0^-1).
[[nodiscard]] Eigen::Matrix3d InverseLeftJacobian(const Eigen::Vector3d& theta);

// A window of one pose that is known to this covariance of (dp, dtheta) in W.
[[nodiscard]] Prior PriorFromCovariance(const Pose& T_WB, const Matrix6d& covariance);

// The same with its motion: (dp, dtheta, dv, dgyro_bias, daccel_bias).
[[nodiscard]] Prior PriorFromCovariance(const Pose& T_WB, const Motion& motion,
                                        const Matrix15d& covariance);

// Adds what is known of the sky's errors, besides and independently.
void AddErrors(const SkyErrors& errors,
               const Eigen::Matrix<double, kSkyErrors, kSkyErrors>& covariance, Prior& prior);

// motion - reference, as the graph's vector.
[[nodiscard]] Eigen::Matrix<double, 9, 1> Difference(const Motion& motion, const Motion& reference);

}  // namespace polnav::nav
