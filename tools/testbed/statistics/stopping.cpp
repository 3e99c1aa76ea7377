#include "tools/testbed/statistics/stopping.h"

#include <cmath>

#include "tools/testbed/statistics/mean.h"

namespace polnav::testbed {
namespace {

constexpr double kCorrection = 4.0;

}  // namespace

std::size_t NextLook(std::size_t n) {
  std::size_t look = kFirstLook;
  while (look <= n) look += (look + 3) / 4;
  return look;
}

bool IsKnownWellEnough(std::span<const double> values, const StoppingRule& rule,
                       std::uint64_t seed) {
  if (values.size() < kFirstLook) return false;
  const Estimated mean = MeanWithInterval(values, seed);
  const double asked = rule.half_width * (rule.relative ? std::abs(mean.value) : 1.0);
  const double correction = 1.0 + kCorrection / static_cast<double>(values.size());
  return mean.interval.HalfWidth() * correction <= asked;
}

std::optional<std::size_t> StopsAt(std::span<const double> values, const StoppingRule& rule,
                                   std::uint64_t seed) {
  for (std::size_t look = NextLook(0); look <= values.size(); look = NextLook(look)) {
    if (IsKnownWellEnough(values.first(look), rule, seed)) return look;
  }
  return std::nullopt;
}

}  // namespace polnav::testbed
