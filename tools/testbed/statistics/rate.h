// How often does something succeed, by so many trials?
#pragma once

#include <cstdint>

#include "tools/testbed/statistics/interval.h"

namespace polnav::testbed {

// Wilson's score interval, with the bounds next to 0 and 1 from the Poisson distribution
// [Brown2001, section 4.1.1]: Wilson's own cover as little as 84 % there. A count is discrete, so
// that the coverage depends on the true rate; docs/study_statistics.md has it.
[[nodiscard]] Estimated RateWithInterval(std::uint64_t successes, std::uint64_t trials);

// Clopper and Pearson's: never covers less than 95 %, often more. For verdicts.
[[nodiscard]] Interval ExactRateInterval(std::uint64_t successes, std::uint64_t trials);

}  // namespace polnav::testbed
