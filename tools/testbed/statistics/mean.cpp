#include "tools/testbed/statistics/mean.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tools/testbed/statistics/resamples.h"

namespace polnav::testbed {
namespace {

double NormalQuantile() {
  return boost::math::quantile(boost::math::normal(), 0.5 + 0.5 * kConfidence);
}

// Of the standardized error (mean - truth) / sigma.
struct Tails {
  double low = 0.0;
  double high = 0.0;
};

// Undoes the cubic that takes the skewness out of a standardized error.
double WithSkewness(double y, double skewness, double n) {
  if (std::abs(skewness) < 1e-6) return y;
  return 3.0 / skewness * (std::cbrt(1.0 + skewness * (y - skewness / (6.0 * n))) - 1.0);
}

Tails AnalyticTails(const Moments& m) {
  const double y = NormalQuantile() / std::sqrt(m.n);
  return {WithSkewness(-y, m.skewness, m.n), WithSkewness(y, m.skewness, m.n)};
}

// The same for every metric of n values; made once. Never cleared while one is in use.
std::shared_ptr<const Resamples> SharedResamples(std::size_t n, std::uint64_t seed) {
  static std::mutex mutex;
  static std::map<std::pair<std::size_t, std::uint64_t>, std::shared_ptr<const Resamples>> made;
  const std::scoped_lock lock(mutex);
  if (made.size() > 64) made.clear();
  std::shared_ptr<const Resamples>& slot = made[{n, seed}];
  if (!slot) slot = std::make_shared<const Resamples>(n, kResampleCount, seed);
  return slot;
}

// The k-th smallest of B with k = p (B + 1): exact for 999 and 2.5 %.
double Quantile(std::vector<double>& values, double p) {
  const double k = std::clamp(p * static_cast<double>(values.size() + 1) - 1.0, 0.0,
                              static_cast<double>(values.size() - 1));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::lround(k));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

Tails TailsOf(std::vector<double>& errors) {
  if (errors.empty()) return {-kInfinity, kInfinity};
  return {Quantile(errors, 0.5 - 0.5 * kConfidence), Quantile(errors, 0.5 + 0.5 * kConfidence)};
}

// Resamples of few values scatter less than the values' kin would: by so much too little, found by
// simulation (docs/study_statistics.md).
Tails Widened(const Tails& tails, double n) {
  constexpr double kOneOverN = 1.2;
  const double factor = 1.0 + kOneOverN / n;
  return {factor * tails.low, factor * tails.high};
}

Tails BootstrapTails(std::span<const double> values, const Moments& m, std::uint64_t seed) {
  const auto resamples = SharedResamples(values.size(), seed);
  std::vector<double> errors;
  errors.reserve(resamples->count());
  for (std::size_t b = 0; b < resamples->count(); ++b) {
    double first = 0.0;
    double second = 0.0;
    for (const std::uint16_t i : resamples->At(b)) {
      const double d = values[i] - m.mean;
      first += d;
      second += d * d;
    }
    const double mean = first / m.n;
    const double variance = second / m.n - mean * mean;
    // One value n times, but for rounding, says nothing.
    if (variance > 1e-12 * m.sigma * m.sigma) errors.push_back(mean / std::sqrt(variance));
  }
  return Widened(TailsOf(errors), m.n);
}

// Influence of each pair on log(mean(a) / mean(b)).
std::vector<double> RatioInfluence(std::span<const double> a, std::span<const double> b,
                                   double mean_a, double mean_b) {
  std::vector<double> u(a.size());
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = a[i] / mean_a - b[i] / mean_b;
  return u;
}

Tails RatioTails(std::span<const double> a, std::span<const double> b, double log_ratio,
                 std::uint64_t seed) {
  const auto resamples = SharedResamples(a.size(), seed);
  const auto n = static_cast<double>(a.size());
  std::vector<double> errors;
  std::vector<double> drawn_a(a.size());
  std::vector<double> drawn_b(a.size());
  for (std::size_t r = 0; r < resamples->count(); ++r) {
    const auto indices = resamples->At(r);
    double mean_a = 0.0;
    double mean_b = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      mean_a += (drawn_a[i] = a[indices[i]]) / n;
      mean_b += (drawn_b[i] = b[indices[i]]) / n;
    }
    if (!(mean_a > 0.0) || !(mean_b > 0.0)) continue;
    const Moments u = ComputeMoments(RatioInfluence(drawn_a, drawn_b, mean_a, mean_b));
    if (u.sigma > 1e-9) errors.push_back((std::log(mean_a / mean_b) - log_ratio) / u.sigma);
  }
  return Widened(TailsOf(errors), n);
}

double TrimmedMean(std::span<const double> sorted) {
  const auto n = static_cast<double>(sorted.size());
  const double share = std::min(0.5 / std::sqrt(n - 4.0), 0.49);  // [Bonett2006]: 1/(2 sqrt(n-4))
  const auto cut = static_cast<std::size_t>(share * n);
  return ComputeMoments(sorted.subspan(cut, sorted.size() - 2 * cut)).mean;
}

}  // namespace

Moments ComputeMoments(std::span<const double> values) {
  if (values.empty()) throw std::logic_error("moments of nothing");
  Moments m{.n = static_cast<double>(values.size())};
  for (const double v : values) m.mean += v;
  m.mean /= m.n;
  double second = 0.0;
  double third = 0.0;
  double fourth = 0.0;
  for (const double v : values) {
    const double d = v - m.mean;
    const double d2 = d * d;
    second += d2;
    third += d2 * d;
    fourth += d2 * d2;
  }
  m.sigma = std::sqrt(second / m.n);
  // What rounding leaves of equal values is no scatter.
  if (m.sigma <= 1e-14 * std::abs(m.mean)) m.sigma = 0.0;
  const double variance = m.sigma * m.sigma;
  if (m.sigma > 0.0) m.skewness = third / m.n / (variance * m.sigma);
  if (m.sigma > 0.0) m.kurtosis = fourth / m.n / (variance * variance);
  return m;
}

Estimated MeanWithInterval(std::span<const double> values, std::uint64_t seed) {
  if (values.empty()) return {};
  const Moments m = ComputeMoments(values);
  if (values.size() < 3) return {m.mean, {}};
  if (m.sigma == 0.0) return {m.mean, {m.mean, m.mean}};
  const Tails tails =
      values.size() > kBootstrapSize ? AnalyticTails(m) : BootstrapTails(values, m, seed);
  return {m.mean, {m.mean - m.sigma * tails.high, m.mean - m.sigma * tails.low}};
}

Estimated ImprovementWithInterval(std::span<const double> a, std::span<const double> b,
                                  std::uint64_t seed) {
  if (a.size() != b.size()) throw std::logic_error("pairs of unequal length");
  if (a.empty()) return {};
  const double mean_a = ComputeMoments(a).mean;
  const double mean_b = ComputeMoments(b).mean;
  if (!(mean_a > 0.0) || !(mean_b > 0.0)) return {};
  const double log_ratio = std::log(mean_a / mean_b);
  const double value = 1.0 - mean_a / mean_b;
  if (a.size() < 3) return {value, {}};
  const Moments u = ComputeMoments(RatioInfluence(a, b, mean_a, mean_b));
  if (u.sigma < 1e-12) return {value, {value, value}};
  const Tails tails =
      a.size() > kBootstrapSize ? AnalyticTails(u) : RatioTails(a, b, log_ratio, seed);
  return {value,
          {1.0 - std::exp(log_ratio - u.sigma * tails.low),
           1.0 - std::exp(log_ratio - u.sigma * tails.high)}};
}

Estimated SpreadWithInterval(std::span<const double> sorted) {
  if (sorted.empty()) return {};
  const Moments m = ComputeMoments(sorted);
  if (sorted.size() == 1) return {0.0, {}};
  const double std = m.sigma * std::sqrt(m.n / (m.n - 1.0));
  if (sorted.size() < 5) return {std, {}};
  if (std == 0.0) return {0.0, {0.0, 0.0}};
  const double centre = TrimmedMean(sorted);
  double fourth = 0.0;
  for (const double v : sorted) {
    const double d2 = (v - centre) * (v - centre);
    fourth += d2 * d2;
  }
  const double kurtosis = fourth / m.n / std::pow(m.sigma, 4);
  const double z = NormalQuantile();
  const double c = m.n / (m.n - z);
  const double error = c * std::sqrt((kurtosis - (m.n - 3.0) / m.n) / (m.n - 1.0));
  return {std,
          {std * std::sqrt(c * std::exp(-z * error)), std * std::sqrt(c * std::exp(z * error))}};
}

}  // namespace polnav::testbed
