// Is one estimator better than another on the same trials?
#pragma once

#include <cstdint>
#include <span>

#include "tools/testbed/statistics/interval.h"

namespace polnav::testbed {

// Of pairs (a, b): differences are a - b; below zero, a is lower.
struct PairedComparison {
  std::uint64_t pairs = 0;
  std::uint64_t lower = 0;   // a < b
  std::uint64_t higher = 0;  // a > b
  Estimated mean_difference;
  Estimated median_difference;
  Estimated improvement;   // 1 - mean(a) / mean(b)
  double sign_test = 1.0;  // p, two-sided: that neither is lower more often
  double wilcoxon = 1.0;   // p, two-sided: that differences are symmetric about zero
};

[[nodiscard]] PairedComparison Compare(std::span<const double> a, std::span<const double> b,
                                       std::uint64_t seed);

// Exact; ties left out before.
[[nodiscard]] double SignTest(std::uint64_t lower, std::uint64_t higher);

// Signed ranks [Wilcoxon1945]: exact up to 50 differences without ties, else normal with ties and
// continuity corrected. Zeros are left out.
[[nodiscard]] double WilcoxonTest(std::span<const double> differences);

}  // namespace polnav::testbed
