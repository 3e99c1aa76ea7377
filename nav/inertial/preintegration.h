// How did the IMU move between two instants, whatever its pose and velocity at the first?
//
// [Forster2017]: readings summed up in the IMU's frame I at the begin, free of gravity,
//   q_Ij = q_Ii dq,  v_j = v_i + g dt + q_Ii dv,  p_j = p_i + v_i dt + g dt^2/2 + q_Ii dp,
// with their covariance and their dependence on the biases, so that a better bias costs no new sum.
// A reading is the mean over its interval, the force seen from the attitude half way
// (docs/imu.md).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "nav/api/calibration.h"
#include "nav/inertial/options.h"

namespace polnav::nav {

using Matrix9d = Eigen::Matrix<double, 9, 9>;

// Of a keyframe, besides its pose: of the IMU's origin, seen in W; and what the readings are off
// by.
struct Motion {
  Eigen::Vector3d v_WI = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();   // [rad/s]
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();  // [m/s^2]
};

// What an estimator counts with: the data sheet and InertialOptions.
struct ImuNoise {
  double gyro_rad_s_sqrt_hz = 0.0;
  double accel_m_s2_sqrt_hz = 0.0;
  // Share of the rate that unknown scale factors and crooked axes fake. It is there as long as the
  // turn is: no noise, but a bias that changes with the turn.
  double share_of_rate = 0.0;
  double gyro_bias_rad_s = 0.0;  // at turn-on
  double accel_bias_m_s2 = 0.0;
  double gyro_walk_rad_s_sqrt_s = 0.0;
  double accel_walk_m_s2_sqrt_s = 0.0;
};

[[nodiscard]] ImuNoise NoiseOf(const ImuCalibration& calibration, const InertialOptions& options);

struct Preintegration {
  double dt_s = 0.0;
  Eigen::Quaterniond dq = Eigen::Quaterniond::Identity();
  Eigen::Vector3d dv = Eigen::Vector3d::Zero();
  Eigen::Vector3d dp = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();  // where it is linearized
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();
  Eigen::Matrix3d dq_by_gyro = Eigen::Matrix3d::Zero();  // right perturbation of dq
  Eigen::Matrix3d dv_by_gyro = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d dv_by_accel = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d dp_by_gyro = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d dp_by_accel = Eigen::Matrix3d::Zero();
  Matrix9d covariance = Matrix9d::Zero();  // of (right perturbation of dq, dv, dp)

  void Add(const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& accel_m_s2, double h_s,
           const ImuNoise& noise);
};

// Jacobian of Log(Exp(theta)^-1 Exp(theta + d)) by d at zero.
[[nodiscard]] Eigen::Matrix3d RightJacobian(const Eigen::Vector3d& theta);

}  // namespace polnav::nav
