#include "tools/testbed/statistics/percentile.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace polnav::testbed {
namespace {

// A lower bound that the percentile is below with probability `miss`. at(k): the k-th value from
// below, from 1.
double LowerBound(std::size_t n, double p, double miss,
                  const std::function<double(std::size_t)>& at) {
  const boost::math::binomial below(static_cast<double>(n), p);
  // Probability that the percentile is below the k-th value: k - 1 values or fewer below it.
  const auto misses = [&](std::size_t k) {
    return boost::math::cdf(below, static_cast<double>(k - 1));
  };
  if (misses(1) > miss) return -kInfinity;
  std::size_t r = 1;      // misses(r) <= miss
  std::size_t above = n;  // the first that misses more often, or n
  while (r + 1 < above) {
    const std::size_t middle = r + (above - r) / 2;
    (misses(middle) <= miss ? r : above) = middle;
  }
  if (above <= r) return at(r);
  const double low = misses(r);
  const double high = misses(above);
  if (high <= miss) return at(above);
  if (miss <= low) return at(r);
  const auto k = static_cast<double>(r);
  const double ratio =
      k * (1.0 - p) * (high - miss) / ((static_cast<double>(n) - k) * p * (miss - low));
  const double weight = 1.0 / (1.0 + ratio);
  return std::lerp(at(r), at(above), weight);
}

double UpperBound(std::span<const double> sorted, double p, double miss) {
  const std::size_t n = sorted.size();
  // Mirrored: the lower bound of what is negated.
  return -LowerBound(n, 1.0 - p, miss, [&](std::size_t k) { return -sorted[n - k]; });
}

}  // namespace

double PercentileOfSorted(std::span<const double> sorted, double percent) {
  if (sorted.empty()) throw std::logic_error("a percentile of nothing");
  const double position = percent / 100.0 * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], position - static_cast<double>(below));
}

Estimated PercentileWithInterval(std::span<const double> sorted, double percent) {
  const double value = PercentileOfSorted(sorted, percent);
  const double p = percent / 100.0;
  const double alpha = 1.0 - kConfidence;
  const auto lower = [&](double miss) {
    return LowerBound(sorted.size(), p, miss, [&](std::size_t k) { return sorted[k - 1]; });
  };
  Interval interval{lower(0.5 * alpha), UpperBound(sorted, p, 0.5 * alpha)};
  const bool open_below = std::isinf(interval.lower);
  const bool open_above = std::isinf(interval.upper);
  if (open_below && !open_above) interval.upper = UpperBound(sorted, p, alpha);
  if (open_above && !open_below) interval.lower = lower(alpha);
  return {value, interval};
}

double CdfBand(std::size_t n) {
  const double root = std::sqrt(static_cast<double>(n));
  return std::sqrt(0.5 * std::log(2.0 / (1.0 - kConfidence))) / (root + 0.12 + 0.11 / root);
}

std::vector<CdfPoint> ThinnedCdf(std::span<const double> sorted, std::size_t points) {
  std::vector<CdfPoint> cdf;
  const std::size_t n = sorted.size();
  const std::size_t count = std::min(n, points);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = count == 1 ? n - 1 : i * (n - 1) / (count - 1);
    cdf.push_back({sorted[k], static_cast<double>(k + 1) / static_cast<double>(n)});
  }
  return cdf;
}

}  // namespace polnav::testbed
