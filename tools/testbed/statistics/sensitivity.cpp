#include "tools/testbed/statistics/sensitivity.h"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <map>
#include <stdexcept>

#include "tools/testbed/statistics/mean.h"
#include "tools/testbed/statistics/ranks.h"

namespace polnav::testbed {
namespace {

constexpr std::size_t kFewestTrials = 20;
constexpr std::size_t kMostGroups = 12;  // numbers of no more kinds than this are groups
constexpr int kDegree = 3;

// Share of the variance, less what k free numbers explain by chance.
double Adjusted(double residual, double total, double n, double k) {
  if (!(total > 0.0) || n - k - 1.0 < 1.0) return std::numeric_limits<double>::quiet_NaN();
  return std::clamp(1.0 - residual / (n - k - 1.0) / (total / (n - 1.0)), 0.0, 1.0);
}

bool SpansDecades(std::span<const double> input) {
  const auto [low, high] = std::minmax_element(input.begin(), input.end());
  return *low > 0.0 && *high > 10.0 * *low;
}

// Standardized; empty when it does not vary.
Eigen::VectorXd Regressor(std::span<const double> input) {
  const bool logarithm = SpansDecades(input);
  std::vector<double> x(input.begin(), input.end());
  if (logarithm)
    std::transform(x.begin(), x.end(), x.begin(), [](double v) { return std::log(v); });
  const Moments m = ComputeMoments(x);
  if (m.sigma == 0.0) return {};
  const Eigen::Map<const Eigen::VectorXd> values(x.data(), static_cast<Eigen::Index>(x.size()));
  return (values.array() - m.mean) / m.sigma;
}

// Empty when there are more than kMostGroups kinds of numbers.
std::vector<std::size_t> GroupsOf(std::span<const double> input) {
  std::map<double, std::size_t> kinds;
  for (const double v : input) {
    kinds.emplace(v, kinds.size());
    if (kinds.size() > kMostGroups) return {};
  }
  std::vector<std::size_t> groups;
  for (const double v : input) groups.push_back(kinds.at(v));
  return groups;
}

}  // namespace

Estimated RankCorrelation(std::span<const double> input, std::span<const double> metric) {
  if (input.size() != metric.size()) throw std::logic_error("pairs of unequal length");
  const auto n = static_cast<double>(input.size());
  if (input.size() < 4) return {};
  const std::vector<double> a = ComputeRanks(input).of;
  const std::vector<double> b = ComputeRanks(metric).of;
  const double middle = 0.5 * (n + 1.0);
  double ab = 0.0;
  double aa = 0.0;
  double bb = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - middle) * (b[i] - middle);
    aa += (a[i] - middle) * (a[i] - middle);
    bb += (b[i] - middle) * (b[i] - middle);
  }
  if (aa == 0.0 || bb == 0.0) return {};
  const double r = ab / std::sqrt(aa * bb);
  if (std::abs(r) >= 1.0 - 1e-12) return {r, {r, r}};
  const double quantile = boost::math::quantile(boost::math::normal(), 0.5 + 0.5 * kConfidence);
  const double half = quantile * std::sqrt((1.0 + 0.5 * r * r) / (n - 3.0));
  return {r, {std::tanh(std::atanh(r) - half), std::tanh(std::atanh(r) + half)}};
}

double FirstOrderOfGroups(std::span<const std::size_t> group, std::span<const double> metric) {
  const Moments m = ComputeMoments(metric);
  std::map<std::size_t, std::pair<double, double>> sums;  // how many, sum
  for (std::size_t i = 0; i < group.size(); ++i) {
    auto& [count, sum] = sums[group[i]];
    count += 1.0;
    sum += metric[i] - m.mean;
  }
  double between = 0.0;
  for (const auto& [id, s] : sums) between += s.second * s.second / s.first;
  const double total = m.n * m.sigma * m.sigma;
  return Adjusted(total - between, total, m.n, static_cast<double>(sums.size()) - 1.0);
}

double FirstOrderIndex(std::span<const double> input, std::span<const double> metric) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  if (input.size() < kFewestTrials) return kNaN;
  if (const std::vector<std::size_t> groups = GroupsOf(input); !groups.empty()) {
    return FirstOrderOfGroups(groups, metric);
  }
  const Eigen::VectorXd x = Regressor(input);
  const Moments m = ComputeMoments(metric);
  if (x.size() == 0 || m.sigma == 0.0) return kNaN;
  const Eigen::Map<const Eigen::VectorXd> raw(metric.data(), x.size());
  const Eigen::VectorXd y = (raw.array() - m.mean) / m.sigma;
  // Normal equations, well conditioned: x is standardized and the degree low.
  Eigen::Matrix<double, kDegree + 1, kDegree + 1> normal;
  Eigen::Matrix<double, kDegree + 1, 1> right;
  normal.setZero();
  right.setZero();
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Eigen::Matrix<double, kDegree + 1, 1> row(1.0, x[i], x[i] * x[i], x[i] * x[i] * x[i]);
    normal += row * row.transpose();
    right += row * y[i];
  }
  const auto solver = normal.ldlt();
  if (solver.info() != Eigen::Success) return kNaN;
  const double explained = right.dot(solver.solve(right));
  return Adjusted(m.n - explained, m.n, m.n, kDegree);
}

Sensitivity ComputeSensitivity(std::span<const double> input, std::span<const double> metric) {
  return {.trials = input.size(),
          .rank_correlation = RankCorrelation(input, metric),
          .first_order = FirstOrderIndex(input, metric)};
}

}  // namespace polnav::testbed
