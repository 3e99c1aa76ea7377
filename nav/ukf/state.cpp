#include "nav/ukf/state.h"

#include <Eigen/Eigenvalues>

namespace polnav::nav::ukf {
namespace {

// Below, turning the covariance changes it by less than its rounding matters.
constexpr double kTurn_rad = 1e-4;

void TurnBlock(Index at, const Eigen::Matrix3d& R, Covariance& P) {
  P.middleRows<3>(at) = (R * P.middleRows<3>(at)).eval();
  P.middleCols<3>(at) = (P.middleCols<3>(at) * R.transpose()).eval();
}

}  // namespace

void Move(const Error& by, State& state) {
  const Eigen::Vector3d theta = by.segment<3>(kTheta);
  const Eigen::Quaterniond turn = Exp(theta);
  state.q_WI = (turn * state.q_WI).normalized();
  state.v_WI = turn * (state.v_WI + by.segment<3>(kVelocity));
  state.p_WI += by.segment<3>(kPosition);
  state.gyro_bias += by.segment<3>(kGyroBias);
  state.accel_bias += by.segment<3>(kAccelBias);
  state.slow += by.tail<kSlow>();
  if (theta.squaredNorm() < kTurn_rad * kTurn_rad) return;
  // Exp(theta + d) = Exp(d') Exp(theta): d' = J_l(theta) d, a turn by half of theta to second
  // order. The velocity's error is seen from the new attitude.
  TurnBlock(kTheta, Exp(0.5 * theta).toRotationMatrix(), state.P);
  TurnBlock(kVelocity, turn.toRotationMatrix(), state.P);
}

// Zero times what is not finite is not a number. A sum is faster than allFinite().
bool IsSound(const Covariance& P) {
  return (0.0 * P.array()).sum() == 0.0 && P.diagonal().minCoeff() >= 0.0;
}

bool Repair(Covariance& P) {
  if (!P.allFinite()) return false;
  Error scale = P.diagonal().cwiseAbs().cwiseSqrt();
  for (double& s : scale) s = s > 0.0 ? s : 1.0;
  const Error inverse = scale.cwiseInverse();
  const Covariance scaled =
      inverse.asDiagonal() * (0.5 * (P + P.transpose())) * inverse.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Covariance> solver(scaled);
  if (solver.info() != Eigen::Success) return false;
  constexpr double kLeast = 1e-9;  // of a variance
  const Covariance mended = solver.eigenvectors() *
                            solver.eigenvalues().cwiseMax(kLeast).asDiagonal() *
                            solver.eigenvectors().transpose();
  P = scale.asDiagonal() * mended * scale.asDiagonal();
  P = 0.5 * (P + P.transpose()).eval();
  return true;
}

}  // namespace polnav::nav::ukf
