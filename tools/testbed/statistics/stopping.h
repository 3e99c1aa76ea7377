// After how many trials is a statistic known well enough?
//
// Trials are looked at in the order of their numbers, at 100 and then at a quarter more each time,
// never in between; the study ends at the first look where the 95 % interval of the statistic is
// narrower than asked by the factor 1 + 4 / n. A rule that stops wherever the interval happens to
// be narrow stops when the scatter is underestimated [Chow1965], and covers as little as 85 % with
// skewed metrics; few looks, none of them early, and the factor bring it back
// (docs/study_statistics.md has figures). The narrower an interval's width scatters the less that
// costs: rates end at once, means one look later, medians two; the outer percentiles cover 93 %
// even then. Wants independent trials: random sampling, not Latin hypercube or Sobol.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>

#include "tools/testbed/statistics/interval.h"

namespace polnav::testbed {

inline constexpr std::size_t kFirstLook = 100;

struct StoppingRule {
  double half_width = 0.0;
  bool relative = false;  // half_width is a share of the statistic's magnitude
  int more_looks = 0;     // after the first that is narrow, before the end
};

// Of a study by "mean", "median", "success_rate" or another statistic.
[[nodiscard]] int MoreLooks(std::string_view statistic);

// The look after n trials; kFirstLook from 0.
[[nodiscard]] std::size_t NextLook(std::size_t n);
// So many looks before the look n; nothing before the first.
[[nodiscard]] std::optional<std::size_t> LookBefore(std::size_t n, int looks);

// Half-width by which a statistic of n values is judged: of its interval, times 1 + 4 / n, and
// with `relative` as a share of its magnitude.
[[nodiscard]] double JudgedHalfWidth(const Estimated& statistic, std::size_t n, bool relative);

// statistic: of the values of a look.
using LookFunction = std::function<Estimated(std::span<const double> values)>;

// The look at which these trials would have ended; nothing when they are too few. What comes after
// does not count: equal for any number of trials that run ahead.
[[nodiscard]] std::optional<std::size_t> StopsAt(std::span<const double> values,
                                                 const StoppingRule& rule,
                                                 const LookFunction& statistic);

}  // namespace polnav::testbed
