// Which place does each value take in the order? From 1; equal values share the mean of theirs.
#pragma once

#include <span>
#include <vector>

namespace polnav::testbed {

struct Ranks {
  std::vector<double> of;
  double tie_sum = 0.0;  // sum over groups of t equal values of t^3 - t
};

[[nodiscard]] Ranks ComputeRanks(std::span<const double> values);

}  // namespace polnav::testbed
