// What instant does a value belong to?
//
// TimeNs counts nanoseconds since the scenario's start (or the dataset's own epoch). It never
// passes through double on its way between modules; a stamp is the middle of an exposure.
#pragma once

#include <cmath>
#include <cstdint>

namespace polnav::nav {

using TimeNs = std::int64_t;

inline constexpr TimeNs kNsPerSecond = 1'000'000'000;

// For differences and reports only: above 2^53 ns (104 days) a double loses nanoseconds.
[[nodiscard]] constexpr double ToSeconds(TimeNs t) { return static_cast<double>(t) * 1e-9; }

[[nodiscard]] inline TimeNs FromSeconds(double seconds) {
  return static_cast<TimeNs>(std::llround(seconds * 1e9));
}

}  // namespace polnav::nav
