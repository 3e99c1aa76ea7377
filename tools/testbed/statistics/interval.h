// Between which numbers does a quantity lie, and how sure is that?
//
// All intervals of a study are 95 % intervals: over many studies, 95 of 100 hold the quantity.
#pragma once

#include <cmath>
#include <limits>

namespace polnav::testbed {

inline constexpr double kConfidence = 0.95;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

// An end that the sample cannot bound is infinite.
struct Interval {
  double lower = -kInfinity;
  double upper = kInfinity;

  [[nodiscard]] bool Holds(double value) const { return lower <= value && value <= upper; }
  [[nodiscard]] double HalfWidth() const { return 0.5 * (upper - lower); }
};

// What was measured, and where the quantity lies.
struct Estimated {
  double value = std::numeric_limits<double>::quiet_NaN();
  Interval interval;
};

}  // namespace polnav::testbed
