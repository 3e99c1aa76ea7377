#include "sky/haze_basis.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "sky/haze_optics.h"

namespace polnav::sky {

namespace {

double Factorial(int n) { return std::tgamma(n + 1.0); }

// Wigner's d^l_mn of the angle whose cosine is x, l from m to kHazeOrders.
Eigen::MatrixXd Wigner(int m, int n, const Eigen::ArrayXd& x) {
  Eigen::MatrixXd d = Eigen::MatrixXd::Zero(kHazeOrders + 1, x.size());
  const int low = std::max(m, std::abs(n));
  const int difference = std::abs(m - n);
  const int sum = std::abs(m + n);
  const double sign = n < m && difference % 2 == 1 ? -1.0 : 1.0;
  const double scale = sign * std::pow(0.5, low) *
                       std::sqrt(Factorial(2 * low) / (Factorial(difference) * Factorial(sum)));
  d.row(low) = scale * (1.0 - x).max(0.0).pow(0.5 * difference) * (1.0 + x).pow(0.5 * sum);
  for (int l = low; l < kHazeOrders; ++l) {
    if (l == 0) {
      d.row(1) = x;
      continue;
    }
    const double both = std::sqrt(static_cast<double>((l * l - m * m) * (l * l - n * n)));
    const int up = l + 1;
    const double next = std::sqrt(static_cast<double>((up * up - m * m) * (up * up - n * n)));
    d.row(up) = (2 * l + 1) * (static_cast<double>(l * up) * x - m * n) *
                d.row(l).transpose().array() / (l * next);
    if (l > low) d.row(up) -= up * both / (l * next) * d.row(l - 1);
  }
  return d.bottomRows(kHazeOrders + 1 - m);
}

}  // namespace

HazeLight& HazeLight::operator+=(const HazeLight& other) {
  i += other.i;
  q += other.q;
  u += other.u;
  return *this;
}

HazeBasis::HazeBasis(int m, const Eigen::ArrayXd& sines) : p(Wigner(m, 0, sines)) {
  const Eigen::MatrixXd same = Wigner(m, 2, sines);
  const Eigen::MatrixXd turned = Wigner(m, -2, sines);
  r = 0.5 * (same + turned);
  t = 0.5 * (turned - same);
}

HazeLight HazeBasis::Shown(const HazeLight& moments) const {
  return {p.transpose() * moments.i, r.transpose() * moments.q + t.transpose() * moments.u,
          t.transpose() * moments.q + r.transpose() * moments.u};
}

HazeLight HazeBasis::Moments(const HazeLight& light) const {
  return {p * light.i, r * light.q + t * light.u, t * light.q + r * light.u};
}

}  // namespace polnav::sky
