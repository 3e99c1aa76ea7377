// Where does a percentile of a metric lie, whatever its distribution?
//
// Between order statistics, by the binomial distribution of how many values fall below it;
// interpolated between two of them so that the interval is not wider than 95 % asks
// [Hettmansperger1986] for the median, [Nyblom1992] for all. Where no order statistic bounds one
// side (the 95th percentile of fewer than 72 values has no upper bound) that side is infinite and
// the other one takes the whole 5 %. Continuous metrics; with ties it covers more.
#pragma once

#include <span>
#include <vector>

#include "tools/testbed/statistics/interval.h"

namespace polnav::testbed {

// In increasing order, at least one; percent strictly between 0 and 100. The value is numpy's.
[[nodiscard]] Estimated PercentileWithInterval(std::span<const double> sorted, double percent);

// numpy's default percentile of values in increasing order; 0 to 100.
[[nodiscard]] double PercentileOfSorted(std::span<const double> sorted, double percent);

// Half-width of the band about the empirical distribution function within which the whole true one
// lies: Dvoretzky, Kiefer and Wolfowitz [Massart1990], with the divisor that makes it exact for few
// values too [Stephens1970] (by the inequality alone 20 values cover 97 %).
[[nodiscard]] double CdfBand(std::size_t n);

// The empirical distribution function at no more than `points` values: value and share at or below.
struct CdfPoint {
  double value = 0.0;
  double share = 0.0;
};
[[nodiscard]] std::vector<CdfPoint> ThinnedCdf(std::span<const double> sorted, std::size_t points);

}  // namespace polnav::testbed
