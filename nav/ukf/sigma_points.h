// Where are the sigma points, when most of a model is linear?
//
// The unscented transform [Julier2004] puts 2n points at the columns of a square root of the
// covariance, +-sqrt(n) of them, weights 1/(2n), none at the centre (kappa = 0: every weight is
// positive, so no covariance loses its definiteness to the transform). Any square root will do. We
// take Cholesky's, with the k directions first in which the model is not linear; the points of the
// other columns do not move along these, the model is exactly linear between them, and what they
// add to mean and covariance is known without evaluating it: P - C C^T, carried by the linear part
// [Morelande2006]. So 2k points are evaluated instead of 2n, with the spread of a transform in k
// dimensions.
#pragma once

#include <array>
#include <cmath>

#include "nav/ukf/state.h"

namespace polnav::nav::ukf {

// Columns of the square root, one a direction; P keeps what they leave.
template <int K>
using Columns = Eigen::Matrix<double, kSize, K>;

// The direction is a functional of the error: of it, P a is its covariance with all and a . P a its
// variance. A variance that is none (lost to rounding) gives an empty column.
inline void TakeColumn(const Error& p_a, double variance, Covariance& P, Eigen::Ref<Error> column) {
  if (!(variance > 0.0)) {
    column.setZero();
    return;
  }
  column = p_a / std::sqrt(variance);
  P.noalias() -= column * column.transpose();
}

inline void TakeColumn(Eigen::Index i, Covariance& P, Eigen::Ref<Error> column) {
  const Error p_a = P.col(i);
  TakeColumn(p_a, P(i, i), P, column);
}

// Of the sum of element i and `factor` times element j.
inline void TakeColumn(Eigen::Index i, Eigen::Index j, double factor, Covariance& P,
                       Eigen::Ref<Error> column) {
  const Error p_a = P.col(i) + factor * P.col(j);
  const double variance = p_a(i) + factor * p_a(j);
  TakeColumn(p_a, variance, P, column);
}

// What a measurement of Z numbers is expected to be.
template <int Z>
struct Expected {
  Eigen::Matrix<double, Z, 1> mean;
  Eigen::Matrix<double, Z, Z> covariance;  // without the measurement's own noise
  Eigen::Matrix<double, kSize, Z> covariance_with_state;
};

// h: error -> measurement, curved along the columns' directions alone; H: its derivative along the
// others, left: what of P the columns leave.
template <int Z, int K, typename Model>
[[nodiscard]] Expected<Z> Expect(const Model& h, const Eigen::Matrix<double, Z, kSize>& H,
                                 const Columns<K>& columns, const Covariance& left) {
  using Vector = Eigen::Matrix<double, Z, 1>;
  const Vector centre = h(Error::Zero());
  const double spread = std::sqrt(static_cast<double>(K));
  std::array<Vector, K> even;
  Vector mean = Vector::Zero();
  Expected<Z> expected;
  expected.covariance_with_state.noalias() = left * H.transpose();
  expected.covariance.noalias() = H * expected.covariance_with_state;
  for (int k = 0; k < K; ++k) {
    const Error point = spread * columns.col(k);
    const Vector plus = h(point);
    const Vector minus = h(-point);
    const Vector odd = 0.5 * (plus - minus);
    even[k] = 0.5 * (plus + minus) - centre;
    mean += even[k] / K;
    expected.covariance += odd * odd.transpose() / K;
    expected.covariance_with_state += columns.col(k) * (odd / spread).transpose();
  }
  for (int k = 0; k < K; ++k) {
    expected.covariance += (even[k] - mean) * (even[k] - mean).transpose() / K;
  }
  expected.mean = centre + mean;
  return expected;
}

}  // namespace polnav::nav::ukf
