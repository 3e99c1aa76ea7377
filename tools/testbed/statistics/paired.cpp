#include "tools/testbed/statistics/paired.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "tools/testbed/statistics/mean.h"
#include "tools/testbed/statistics/percentile.h"
#include "tools/testbed/statistics/ranks.h"

namespace polnav::testbed {
namespace {

constexpr std::size_t kExactWilcoxon = 50;

// P(W <= w) of the sum of ranks 1..n, each with a fair coin's sign.
double SignedRankCdf(std::size_t n, std::size_t w) {
  std::vector<double> share(n * (n + 1) / 2 + 1, 0.0);
  share[0] = 1.0;
  std::size_t top = 0;
  for (std::size_t rank = 1; rank <= n; ++rank) {
    top += rank;
    for (std::size_t s = top + 1; s-- > 0;) {
      share[s] = 0.5 * (share[s] + (s >= rank ? share[s - rank] : 0.0));
    }
  }
  double sum = 0.0;
  for (std::size_t s = 0; s <= w && s < share.size(); ++s) sum += share[s];
  return sum;
}

}  // namespace

double SignTest(std::uint64_t lower, std::uint64_t higher) {
  const std::uint64_t n = lower + higher;
  if (n == 0) return 1.0;
  const boost::math::binomial fair(static_cast<double>(n), 0.5);
  return std::min(1.0, 2.0 * boost::math::cdf(fair, static_cast<double>(std::min(lower, higher))));
}

double WilcoxonTest(std::span<const double> differences) {
  std::vector<double> magnitude;
  std::vector<bool> positive;
  for (const double d : differences) {
    if (d == 0.0) continue;
    magnitude.push_back(std::abs(d));
    positive.push_back(d > 0.0);
  }
  if (magnitude.empty()) return 1.0;
  const Ranks ranks = ComputeRanks(magnitude);
  const auto n = static_cast<double>(magnitude.size());
  double above = 0.0;
  for (std::size_t i = 0; i < magnitude.size(); ++i) above += positive[i] ? ranks.of[i] : 0.0;
  const double all = 0.5 * n * (n + 1.0);
  const double w = std::min(above, all - above);
  if (magnitude.size() <= kExactWilcoxon && ranks.tie_sum == 0.0) {
    return std::min(1.0, 2.0 * SignedRankCdf(magnitude.size(), static_cast<std::size_t>(w)));
  }
  const double variance = n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - ranks.tie_sum / 48.0;
  const double z = (w - 0.5 * all + 0.5) / std::sqrt(variance);
  return std::min(1.0, 2.0 * boost::math::cdf(boost::math::normal(), z));
}

PairedComparison Compare(std::span<const double> a, std::span<const double> b, std::uint64_t seed) {
  if (a.size() != b.size()) throw std::logic_error("pairs of unequal length");
  PairedComparison comparison{.pairs = a.size()};
  if (a.empty()) return comparison;
  std::vector<double> differences(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    differences[i] = a[i] - b[i];
    comparison.lower += differences[i] < 0.0 ? 1 : 0;
    comparison.higher += differences[i] > 0.0 ? 1 : 0;
  }
  comparison.mean_difference = MeanWithInterval(differences, seed);
  comparison.improvement = ImprovementWithInterval(a, b, seed);
  comparison.sign_test = SignTest(comparison.lower, comparison.higher);
  comparison.wilcoxon = WilcoxonTest(differences);
  std::sort(differences.begin(), differences.end());
  comparison.median_difference = PercentileWithInterval(differences, 50.0);
  return comparison;
}

}  // namespace polnav::testbed
