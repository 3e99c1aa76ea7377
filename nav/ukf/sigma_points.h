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

// Columns of the square root, one a direction.
template <int K>
using Columns = Eigen::Matrix<double, kSize, K>;

// A functional of the error: its element i and, where there is one, `factor` times element j.
struct Direction {
  Eigen::Index i;
  Eigen::Index j = -1;
  double factor = 0.0;

  template <typename Column>
  [[nodiscard]] double Of(const Column& error) const {
    return j < 0 ? error(i) : error(i) + factor * error(j);
  }
};

// Each column is the direction's covariance with all, less what those before it explain, over its
// sigma. A variance that is none (lost to rounding) gives an empty column.
template <int K>
[[nodiscard]] Columns<K> TakeColumns(const std::array<Direction, K>& directions,
                                     const Covariance& P) {
  constexpr double kRounding = 1e-13;  // of a variance
  Columns<K> columns;
  for (int k = 0; k < K; ++k) {
    const Direction& d = directions[k];
    Error column = P.col(d.i);
    if (d.j >= 0) column += d.factor * P.col(d.j);
    const double whole = d.Of(column);
    for (int before = 0; before < k; ++before) {
      column -= d.Of(columns.col(before)) * columns.col(before);
    }
    const double variance = d.Of(column);
    if (variance > kRounding * whole && whole > 0.0) {
      columns.col(k) = column / std::sqrt(variance);
    } else {
      columns.col(k).setZero();
    }
  }
  return columns;
}

// What a measurement of Z numbers is expected to be.
template <int Z>
struct Expected {
  Eigen::Matrix<double, Z, 1> mean;
  Eigen::Matrix<double, Z, Z> covariance;  // without the measurement's own noise
  Eigen::Matrix<double, kSize, Z> covariance_with_state;
};

// h: error -> measurement, curved along the directions alone; H: its derivative along the others.
template <int Z, int K, typename Model>
[[nodiscard]] Expected<Z> Expect(const Model& h, const Eigen::Matrix<double, Z, kSize>& H,
                                 const std::array<Direction, K>& directions, const Covariance& P) {
  using Vector = Eigen::Matrix<double, Z, 1>;
  const Vector centre = h(Error::Zero());
  const double spread = std::sqrt(static_cast<double>(K));
  const Columns<K> columns = TakeColumns<K>(directions, P);
  std::array<Vector, K> even;
  Vector mean = Vector::Zero();
  Expected<Z> expected;
  // What the columns leave of P, carried by the linear part.
  const Eigen::Matrix<double, K, Z> taken = columns.transpose() * H.transpose();
  expected.covariance_with_state.noalias() = P * H.transpose();
  expected.covariance_with_state.noalias() -= columns * taken;
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
