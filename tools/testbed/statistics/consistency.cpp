#include "tools/testbed/statistics/consistency.h"

#include <boost/math/distributions/chi_squared.hpp>

#include "tools/testbed/statistics/mean.h"

namespace polnav::testbed {

const char* NameOf(Honesty honesty) {
  switch (honesty) {
    case Honesty::kUnknown:
      return "unknown";
    case Honesty::kHonest:
      return "honest";
    case Honesty::kOverconfident:
      return "overconfident";
    case Honesty::kUnderconfident:
      return "underconfident";
  }
  return "";
}

Interval ChiSquareBounds(std::uint64_t trials, double dof) {
  if (trials == 0) return {};
  const auto n = static_cast<double>(trials);
  const boost::math::chi_squared chi2(n * dof);
  return {boost::math::quantile(chi2, 0.5 - 0.5 * kConfidence) / n,
          boost::math::quantile(chi2, 0.5 + 0.5 * kConfidence) / n};
}

Consistency CheckConsistency(std::span<const double> values, double dof, std::uint64_t seed) {
  Consistency result{.trials = values.size(),
                     .dof = dof,
                     .mean = MeanWithInterval(values, seed),
                     .bounds = ChiSquareBounds(values.size(), dof)};
  if (values.size() < 3) return result;
  if (result.mean.interval.lower > dof) {
    result.verdict = Honesty::kOverconfident;
  } else if (result.mean.interval.upper < dof) {
    result.verdict = Honesty::kUnderconfident;
  } else {
    result.verdict = Honesty::kHonest;
  }
  return result;
}

}  // namespace polnav::testbed
