// How much does a metric depend on a dispersed input?
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tools/testbed/statistics/interval.h"

namespace polnav::testbed {

struct Sensitivity {
  std::uint64_t trials = 0;
  // Spearman's, -1 to 1: does the metric rise with the input? Interval by Fisher's z with the
  // variance of ranks [BonettWright2000]. NaN where either does not vary.
  Estimated rank_correlation;
  // Share of the metric's variance that this input alone explains: cubic regression, adjusted for
  // what chance explains, 0 to 1. Also finds what rises and falls. NaN with fewer than 20 trials.
  double first_order = std::numeric_limits<double>::quiet_NaN();
};

[[nodiscard]] Estimated RankCorrelation(std::span<const double> input,
                                        std::span<const double> metric);

// Of an input of numbers. Their logarithm where all are positive over more than a decade.
[[nodiscard]] double FirstOrderIndex(std::span<const double> input, std::span<const double> metric);

// Of groups: inputs that are text, or numbers of a few kinds. Adjusted correlation ratio.
[[nodiscard]] double FirstOrderOfGroups(std::span<const std::size_t> group,
                                        std::span<const double> metric);

[[nodiscard]] Sensitivity ComputeSensitivity(std::span<const double> input,
                                             std::span<const double> metric);

}  // namespace polnav::testbed
