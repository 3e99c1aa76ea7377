// Where does the mean of a metric lie, or the ratio of two, or the standard deviation?
//
// Up to kBootstrapSize values the studentized bootstrap [Hall1992, eq. 1.3]: percentile and BCa
// intervals, and Student's t, of 20 skewed values miss far more often than one time in twenty.
// Above, Hall's cubic transformation takes out the skewness and the quantile is the normal one,
// O(n) [Hall1992, section 3]. Wants a finite variance: with tails as heavy as a lognormal's of
// sigma 1 the mean is missed more often (docs/study_statistics.md has figures).
#pragma once

#include <cstdint>
#include <span>

#include "tools/testbed/statistics/interval.h"

namespace polnav::testbed {

inline constexpr std::size_t kBootstrapSize = 300;
inline constexpr std::size_t kResampleCount = 999;

struct Moments {
  double n = 0.0;
  double mean = 0.0;
  double sigma = 0.0;  // divided by n
  double skewness = 0.0;
  double kurtosis = 0.0;  // 3 when normal
};

// Of at least one value.
[[nodiscard]] Moments ComputeMoments(std::span<const double> values);

// Unbounded with fewer than three values. Of equal values: that value.
[[nodiscard]] Estimated MeanWithInterval(std::span<const double> values, std::uint64_t seed);

// 1 - mean(a) / mean(b) of pairs: by how much a is lower than b, as a share of b. Studentized on
// the logarithm of the ratio; nothing known unless both means are positive.
[[nodiscard]] Estimated ImprovementWithInterval(std::span<const double> a,
                                                std::span<const double> b, std::uint64_t seed);

// Standard deviation (divided by n - 1) of values of any kurtosis [Bonett2006, eq. 5, with the
// moment about a trimmed mean]. values in increasing order; unbounded with fewer than four.
[[nodiscard]] Estimated SpreadWithInterval(std::span<const double> sorted);

}  // namespace polnav::testbed
