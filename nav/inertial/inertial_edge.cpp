#include "nav/inertial/inertial_edge.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>

#include "nav/graph/edges.h"
#include "nav/stereo/reprojection.h"

namespace polnav::nav {
namespace {

const Eigen::Vector3d kGravity_W(0.0, 0.0, -kGravity_m_s2);

// The sums at the bias that a keyframe is believed to have.
struct Corrected {
  Eigen::Vector3d turn;  // rotation vector by which the gyro bias moves dq
  Eigen::Quaterniond dq;
  Eigen::Vector3d dv;
  Eigen::Vector3d dp;
};

Corrected Correct(const Preintegration& sum, const Motion& motion) {
  const Eigen::Vector3d gyro = motion.gyro_bias - sum.gyro_bias;
  const Eigen::Vector3d accel = motion.accel_bias - sum.accel_bias;
  const Eigen::Vector3d turn = sum.dq_by_gyro * gyro;
  return {turn, sum.dq * ExpRotation(turn),
          sum.dv + sum.dv_by_gyro * gyro + sum.dv_by_accel * accel,
          sum.dp + sum.dp_by_gyro * gyro + sum.dp_by_accel * accel};
}

}  // namespace

InertialEdge MakeInertialEdge(const Preintegration& sum, const BiasWalk& walk, const Pose& T_BI) {
  const Eigen::LLT<Matrix9d> covariance(sum.covariance);
  if (covariance.info() != Eigen::Success) {
    throw std::logic_error("MakeInertialEdge: the covariance is not positive definite");
  }
  return {.sum = sum,
          .T_BI = T_BI,
          .weight = covariance.matrixL().solve(Matrix9d::Identity()),
          .gyro_walk_weight = 1.0 / walk.gyro_rad_s,
          .accel_walk_weight = 1.0 / walk.accel_m_s2};
}

InertialResidual EvaluateInertial(const InertialEdge& edge, const Pose& T_WBi,
                                  const Motion& motion_i, const Pose& T_WBj,
                                  const Motion& motion_j) {
  const Preintegration& sum = edge.sum;
  const double dt = sum.dt_s;
  const Corrected c = Correct(sum, motion_i);
  const Eigen::Quaterniond q_i = T_WBi.q * edge.T_BI.q;
  const Eigen::Quaterniond q_j = T_WBj.q * edge.T_BI.q;
  const Eigen::Matrix3d R_iW = q_i.conjugate().toRotationMatrix();
  const Eigen::Vector3d arm_i = T_WBi.q * edge.T_BI.p;
  const Eigen::Vector3d arm_j = T_WBj.q * edge.T_BI.p;
  const Eigen::Vector3d dv_W = motion_j.v_WI - motion_i.v_WI - dt * kGravity_W;
  const Eigen::Vector3d dp_W =
      T_WBj.p + arm_j - T_WBi.p - arm_i - dt * motion_i.v_WI - 0.5 * dt * dt * kGravity_W;
  Eigen::Matrix<double, 9, 1> r;
  r.head<3>() = LogRotation(c.dq.conjugate() * q_i.conjugate() * q_j);
  r.segment<3>(3) = R_iW * dv_W - c.dv;
  r.tail<3>() = R_iW * dp_W - c.dp;

  // The right inverse Jacobian is the left one's transpose.
  const Eigen::Matrix3d left = InverseLeftJacobian(r.head<3>());
  const Eigen::Matrix3d by_turn = left.transpose() * q_j.conjugate().toRotationMatrix();
  Eigen::Matrix<double, 9, 6> pose_i = Eigen::Matrix<double, 9, 6>::Zero();
  Eigen::Matrix<double, 9, 6> pose_j = Eigen::Matrix<double, 9, 6>::Zero();
  Matrix9d by_i = Matrix9d::Zero();
  Eigen::Matrix<double, 9, 3> velocity_j = Eigen::Matrix<double, 9, 3>::Zero();
  pose_i.block<3, 3>(0, 3) = -by_turn;
  pose_j.block<3, 3>(0, 3) = by_turn;
  pose_i.block<3, 3>(3, 3) = R_iW * Skew(dv_W);
  pose_i.block<3, 3>(6, 0) = -R_iW;
  pose_i.block<3, 3>(6, 3) = R_iW * (Skew(dp_W) + Skew(arm_i));
  pose_j.block<3, 3>(6, 0) = R_iW;
  pose_j.block<3, 3>(6, 3) = -R_iW * Skew(arm_j);
  by_i.block<3, 3>(3, 0) = -R_iW;
  by_i.block<3, 3>(6, 0) = -dt * R_iW;
  by_i.block<3, 3>(0, 3) = -left * RightJacobian(c.turn) * sum.dq_by_gyro;
  by_i.block<3, 3>(3, 3) = -sum.dv_by_gyro;
  by_i.block<3, 3>(6, 3) = -sum.dp_by_gyro;
  by_i.block<3, 3>(3, 6) = -sum.dv_by_accel;
  by_i.block<3, 3>(6, 6) = -sum.dp_by_accel;
  velocity_j.block<3, 3>(3, 0) = R_iW;

  InertialResidual e;
  const Eigen::Matrix3d gyro_walk = edge.gyro_walk_weight * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d accel_walk = edge.accel_walk_weight * Eigen::Matrix3d::Identity();
  e.residual << edge.weight * r, gyro_walk * (motion_j.gyro_bias - motion_i.gyro_bias),
      accel_walk * (motion_j.accel_bias - motion_i.accel_bias);
  e.by_pose_i.setZero();
  e.by_pose_i.topRows<9>() = edge.weight * pose_i;
  e.by_pose_j.setZero();
  e.by_pose_j.topRows<9>() = edge.weight * pose_j;
  e.by_motion_i.setZero();
  e.by_motion_i.topRows<9>() = edge.weight * by_i;
  e.by_motion_i.block<3, 3>(9, 3) = -gyro_walk;
  e.by_motion_i.block<3, 3>(12, 6) = -accel_walk;
  e.by_motion_j.setZero();
  e.by_motion_j.block<9, 3>(0, 0) = edge.weight * velocity_j;
  e.by_motion_j.block<3, 3>(9, 3) = gyro_walk;
  e.by_motion_j.block<3, 3>(12, 6) = accel_walk;
  return e;
}

InertialPrediction Predict(const Preintegration& sum, const Pose& T_BI, const Pose& T_WBi,
                           const Motion& motion_i, const Matrix15d& state_covariance) {
  const double dt = sum.dt_s;
  const Corrected c = Correct(sum, motion_i);
  const Eigen::Quaterniond q_i = T_WBi.q * T_BI.q;
  const Eigen::Matrix3d R_i = q_i.toRotationMatrix();
  const Eigen::Matrix3d R_j = (q_i * c.dq).toRotationMatrix();
  InertialPrediction answer;
  answer.T_WB.q = (q_i * c.dq * T_BI.q.conjugate()).normalized();
  answer.v_WI = motion_i.v_WI + dt * kGravity_W + R_i * c.dv;
  answer.T_WB.p = T_WBi * T_BI.p + dt * motion_i.v_WI + 0.5 * dt * dt * kGravity_W + R_i * c.dp -
                  answer.T_WB.q * T_BI.p;

  // Errors of (dp, dtheta, dv) of B in W by those of the sums (attitude, velocity, position) ...
  const Eigen::Matrix3d arm = Skew(answer.T_WB.q * T_BI.p);
  Matrix9d by_sum = Matrix9d::Zero();
  by_sum.block<3, 3>(3, 0) = R_j;
  by_sum.block<3, 3>(6, 3) = R_i;
  by_sum.block<3, 3>(0, 6) = R_i;
  by_sum.block<3, 3>(0, 0) = arm * R_j;
  // ... and by the keyframe's (dtheta, dv, dgyro_bias, daccel_bias): an attitude error turns the
  // sums, landmarks and all, but gravity and velocity stay as they are in W.
  Eigen::Matrix<double, 9, 12> by_state = Eigen::Matrix<double, 9, 12>::Zero();
  by_state.block<3, 3>(0, 0) = dt * Skew(motion_i.v_WI + 0.5 * dt * kGravity_W);
  by_state.block<3, 3>(6, 0) = Skew(motion_i.v_WI + dt * kGravity_W);
  by_state.block<3, 3>(0, 3) = dt * Eigen::Matrix3d::Identity();
  by_state.block<3, 3>(6, 3).setIdentity();
  by_state.block<3, 3>(0, 6) = R_i * sum.dp_by_gyro + arm * R_j * sum.dq_by_gyro;
  by_state.block<3, 3>(3, 6) = R_j * sum.dq_by_gyro;
  by_state.block<3, 3>(6, 6) = R_i * sum.dv_by_gyro;
  by_state.block<3, 3>(0, 9) = R_i * sum.dp_by_accel;
  by_state.block<3, 3>(6, 9) = R_i * sum.dv_by_accel;
  answer.covariance =
      by_sum * sum.covariance * by_sum.transpose() +
      by_state * state_covariance.bottomRightCorner<12, 12>() * by_state.transpose();
  return answer;
}

}  // namespace polnav::nav
