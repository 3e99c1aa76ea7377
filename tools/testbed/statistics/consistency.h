// Are errors (NEES) or innovations (NIS) as large as the covariance says?
//
// Averaged over N trials an honest filter's NEES of d degrees of freedom is d, N times the average
// is chi-square with N d [BarShalom2001, section 5.4.2]. A trial's NEES is itself a mean over time;
// whatever its correlation it scatters less than one value, so that the bounds are then on the safe
// side: outside them the filter is not honest. The interval of the mean from the trials' own
// scatter says more, and is the one that a verdict takes.
#pragma once

#include <cstdint>
#include <span>

#include "tools/testbed/statistics/interval.h"

namespace polnav::testbed {

enum class Honesty {
  kUnknown,  // too few trials
  kHonest,
  kOverconfident,   // errors larger than believed
  kUnderconfident,  // smaller
};

[[nodiscard]] const char* NameOf(Honesty honesty);

struct Consistency {
  std::uint64_t trials = 0;
  double dof = 1.0;
  Estimated mean;   // ANEES or ANIS, d when honest, with the interval from the trials' scatter
  Interval bounds;  // about d: chi-square
  Honesty verdict = Honesty::kUnknown;  // by the interval of the mean
};

[[nodiscard]] Interval ChiSquareBounds(std::uint64_t trials, double dof);

// values: of each trial, d when honest.
[[nodiscard]] Consistency CheckConsistency(std::span<const double> values, double dof,
                                           std::uint64_t seed);

}  // namespace polnav::testbed
