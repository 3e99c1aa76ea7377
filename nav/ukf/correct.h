// What does a measurement change, once it is known what was expected of it?
//
// Kalman's gain, but for the considered elements of the error, whose gain is zero
// [Schmidt1966]: they are not learned, and what they make uncertain stays uncertain.
#pragma once

#include <Eigen/LU>

#include "nav/ukf/sigma_points.h"

namespace polnav::nav::ukf {

struct Correction {
  double nis = 0.0;
  bool gated = false;
  bool repaired = false;  // the covariance had lost its definiteness
  bool usable = true;     // false: a number that is none; the state is as it was
};

// Elements that stay as they are, though they could be learned.
struct Kept {
  Eigen::Index first = 0;
  Eigen::Index count = 0;
};

// residual: measured less expected. Beyond gate_sigmas the state stays as it is.
template <int Z>
[[nodiscard]] Correction Correct(const Expected<Z>& expected,
                                 const Eigen::Matrix<double, Z, 1>& residual,
                                 const Eigen::Matrix<double, Z, Z>& noise, double gate_sigmas,
                                 State& state, const Kept& kept = {}) {
  using Square = Eigen::Matrix<double, Z, Z>;
  const Square covariance = expected.covariance + noise;
  const Square inverse = covariance.inverse();
  Correction correction{.nis = residual.dot(inverse * residual)};
  // A covariance without definiteness gives a negative square, or none.
  if (!(correction.nis >= 0.0) || !std::isfinite(correction.nis)) {
    correction.usable = false;
    return correction;
  }
  correction.gated = correction.nis > gate_sigmas * gate_sigmas;
  if (correction.gated) return correction;
  const auto& c = expected.covariance_with_state;
  Eigen::Matrix<double, kSize, Z> gain = c * inverse;
  gain.template bottomRows<kSize - kEstimated>().setZero();
  for (Eigen::Index i = kept.first; i < kept.first + kept.count; ++i) gain.row(i).setZero();
  // (1 - K H) P (1 - K H)^T + K R K^T of whatever gain: P - K b^T - b K^T with b = c - K S / 2.
  const Eigen::Matrix<double, kSize, Z> b = c - 0.5 * gain * covariance;
  // Of two considered elements nothing changes.
  const auto moving = gain.template topRows<kEstimated>();
  for (Eigen::Index j = 0; j < kEstimated; ++j) {
    state.P.col(j).template head<kEstimated>().noalias() -= moving * b.row(j).transpose();
    state.P.col(j).noalias() -= b * gain.row(j).transpose();
  }
  for (Eigen::Index j = kEstimated; j < kSize; ++j) {
    state.P.col(j).template head<kEstimated>().noalias() -= moving * b.row(j).transpose();
  }
  if (!IsSound(state.P)) correction.repaired = Repair(state.P);
  Move(gain * residual, state);
  return correction;
}

}  // namespace polnav::nav::ukf
