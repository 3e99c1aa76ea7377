#include "tools/testbed/study/distributions.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>
#include <numeric>

namespace polnav::testbed {
namespace {

// P(Z < z), exact to relative precision where it is small.
double LowerTail(double z) { return 0.5 * boost::math::erfc(-z / std::numbers::sqrt2); }

double StandardQuantile(double lower_tail) {
  return -std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * lower_tail);
}

}  // namespace

double NormalQuantile(double u, double mean, double sigma) {
  return mean + sigma * StandardQuantile(u);
}

double TruncatedNormalQuantile(double u, double mean, double sigma, double min, double max) {
  double a = (min - mean) / sigma;
  double b = (max - mean) / sigma;
  // Mirrored into the lower tail, where probabilities do not round to one.
  const bool mirrored = a > 0.0;
  if (mirrored) {
    std::swap(a, b);
    a = -a;
    b = -b;
    u = 1.0 - u;
  }
  const double below = LowerTail(a);
  const double p = below + u * (LowerTail(b) - below);
  // Beyond 38 sigma nothing is left to tell apart: the nearer end.
  const double z = p > 0.0 && p < 1.0 ? StandardQuantile(p) : (p <= 0.0 ? b : a);
  return std::clamp(mean + sigma * (mirrored ? -z : z), min, max);
}

double UniformQuantile(double u, double min, double max) {
  return std::clamp(min + u * (max - min), min, max);
}

double LogUniformQuantile(double u, double min, double max) {
  return std::clamp(min * std::exp(u * std::log(max / min)), min, max);
}

std::size_t DiscreteQuantile(double u, std::size_t count, const std::vector<double>& weights) {
  if (weights.empty()) {
    return std::min(static_cast<std::size_t>(u * static_cast<double>(count)), count - 1);
  }
  double left = u * std::accumulate(weights.begin(), weights.end(), 0.0);
  std::size_t last_possible = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (weights[i] <= 0.0) continue;
    if (left < weights[i]) return i;
    left -= weights[i];
    last_possible = i;
  }
  return last_possible;
}

std::optional<Eigen::MatrixXd> CholeskyFactor(const Eigen::MatrixXd& covariance) {
  const double scale = covariance.cwiseAbs().maxCoeff();
  if (!(covariance - covariance.transpose()).isZero(1e-12 * scale)) return std::nullopt;
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
  if (llt.info() != Eigen::Success) return std::nullopt;
  return llt.matrixL().toDenseMatrix();
}

}  // namespace polnav::testbed
