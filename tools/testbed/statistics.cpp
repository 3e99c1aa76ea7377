#include "tools/testbed/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace polnav::testbed {
namespace {

bool AllFinite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double Percentile(std::vector<double> values, double percent) {
  if (values.empty()) throw std::logic_error("a percentile of nothing");
  if (!AllFinite(values)) return kNaN;  // NaN has no place in an order
  std::sort(values.begin(), values.end());
  const double position = percent / 100.0 * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], position - static_cast<double>(below));
}

Statistics Summarize(const std::vector<double>& values) {
  if (values.empty()) throw std::logic_error("statistics of nothing");
  const auto n = static_cast<double>(values.size());
  Statistics s;
  s.count = values.size();
  if (!AllFinite(values)) return {kNaN, kNaN, kNaN, kNaN, kNaN, kNaN, kNaN, s.count};
  s.min = *std::min_element(values.begin(), values.end());
  s.max = *std::max_element(values.begin(), values.end());
  for (const double v : values) {
    s.mean += v;
    s.sse += v * v;
  }
  s.mean /= n;
  s.rmse = std::sqrt(s.sse / n);
  double scatter = 0.0;
  for (const double v : values) scatter += (v - s.mean) * (v - s.mean);
  s.std = std::sqrt(scatter / n);
  s.median = Percentile(values, 50.0);
  return s;
}

}  // namespace polnav::testbed
