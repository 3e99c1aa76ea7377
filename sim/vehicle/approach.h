// How does a command follow what is wanted, when it may change by so much a step?
#pragma once

#include <algorithm>

namespace polnav::sim {

[[nodiscard]] inline double Approach(double from, double to, double most) {
  return from + std::clamp(to - from, -most, most);
}

}  // namespace polnav::sim
