// What is a series of errors in a few numbers? numpy's and evo's definitions.
#pragma once

#include <cstddef>
#include <vector>

namespace polnav::testbed {

struct Statistics {
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;  // mean of the middle two when even
  double std = 0.0;     // of the population: divided by n
  double min = 0.0;
  double max = 0.0;
  double sse = 0.0;  // sum of squares
  std::size_t count = 0;
};

// Of at least one value; an empty series throws std::logic_error. One value that is not finite
// makes every number NaN: an estimator that diverged has no statistics.
[[nodiscard]] Statistics Summarize(const std::vector<double>& values);

// numpy's default (linear) percentile, 0 to 100.
[[nodiscard]] double Percentile(std::vector<double> values, double percent);

}  // namespace polnav::testbed
