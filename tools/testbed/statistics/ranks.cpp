#include "tools/testbed/statistics/ranks.h"

#include <algorithm>
#include <numeric>

namespace polnav::testbed {

Ranks ComputeRanks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return values[i] < values[j] || (values[i] == values[j] && i < j);
  });
  Ranks ranks{.of = std::vector<double>(values.size())};
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    const auto t = static_cast<double>(end - first);
    for (std::size_t k = first; k < end; ++k) {
      ranks.of[order[k]] = 0.5 * static_cast<double>(first + 1 + end);
    }
    ranks.tie_sum += t * t * t - t;
    first = end;
  }
  return ranks;
}

}  // namespace polnav::testbed
