// After how many trials is a mean known well enough?
//
// Trials are looked at in the order of their numbers, at 100 and then at a quarter more each time,
// never in between; the study ends at the first look where the mean's 95 % interval is narrower
// than asked by the factor 1 + 4 / n. A rule that stops wherever the interval happens to be narrow
// stops when the scatter is underestimated [Chow1965], and covers as little as 85 % with skewed
// metrics; few looks, none of them early, and the factor bring it back (docs/study_statistics.md
// has figures). Wants independent trials: random sampling, not Latin hypercube or Sobol.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "tools/testbed/statistics/interval.h"

namespace polnav::testbed {

inline constexpr std::size_t kFirstLook = 100;

struct StoppingRule {
  double half_width = 0.0;
  bool relative = false;  // half_width is a share of the mean's magnitude
};

// The look after n trials; kFirstLook from 0.
[[nodiscard]] std::size_t NextLook(std::size_t n);

// values: of the trials 0 .. n-1 where n is a look.
[[nodiscard]] bool IsKnownWellEnough(std::span<const double> values, const StoppingRule& rule,
                                     std::uint64_t seed);

// The look at which these trials would have ended; nothing when they are too few. What comes after
// does not count: equal for any number of trials that run ahead.
[[nodiscard]] std::optional<std::size_t> StopsAt(std::span<const double> values,
                                                 const StoppingRule& rule, std::uint64_t seed);

}  // namespace polnav::testbed
