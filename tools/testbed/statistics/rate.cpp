#include "tools/testbed/statistics/rate.h"

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

namespace polnav::testbed {
namespace {

constexpr double kAlpha = 1.0 - kConfidence;

double WilsonLower(double x, double n) {
  const double z = boost::math::quantile(boost::math::normal(), 1.0 - 0.5 * kAlpha);
  const double centre = x + 0.5 * z * z;
  const double spread = z * std::sqrt(x * (n - x) / n + 0.25 * z * z);
  return std::max(0.0, (centre - spread) / (n + z * z));
}

double LowerBound(std::uint64_t successes, std::uint64_t trials) {
  const auto x = static_cast<double>(successes);
  const auto n = static_cast<double>(trials);
  const std::uint64_t few = trials <= 50 ? 2 : 3;
  if (successes == 0) return 0.0;
  if (successes > few || successes >= trials) return WilsonLower(x, n);
  return 0.5 * boost::math::quantile(boost::math::chi_squared(2.0 * x), kAlpha) / n;
}

}  // namespace

Estimated RateWithInterval(std::uint64_t successes, std::uint64_t trials) {
  if (trials == 0) return {};
  return {static_cast<double>(successes) / static_cast<double>(trials),
          {LowerBound(successes, trials), 1.0 - LowerBound(trials - successes, trials)}};
}

Interval ExactRateInterval(std::uint64_t successes, std::uint64_t trials) {
  if (trials == 0) return {0.0, 1.0};
  const auto x = static_cast<double>(successes);
  const auto n = static_cast<double>(trials);
  Interval interval{0.0, 1.0};
  if (successes > 0) {
    interval.lower =
        boost::math::quantile(boost::math::beta_distribution(x, n - x + 1.0), 0.5 * kAlpha);
  }
  if (successes < trials) {
    interval.upper =
        boost::math::quantile(boost::math::beta_distribution(x + 1.0, n - x), 1.0 - 0.5 * kAlpha);
  }
  return interval;
}

}  // namespace polnav::testbed
