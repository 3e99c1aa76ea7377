#include "tools/testbed/statistics/stopping.h"

#include <cmath>
#include <vector>

namespace polnav::testbed {
namespace {

constexpr double kCorrection = 4.0;

}  // namespace

int MoreLooks(std::string_view statistic) {
  if (statistic == "success_rate") return 0;
  return statistic == "median" ? 2 : 1;
}

std::size_t NextLook(std::size_t n) {
  std::size_t look = kFirstLook;
  while (look <= n) look += (look + 3) / 4;
  return look;
}

std::optional<std::size_t> LookBefore(std::size_t n, int looks) {
  std::vector<std::size_t> all;
  for (std::size_t look = NextLook(0); look <= n; look = NextLook(look)) all.push_back(look);
  const auto back = static_cast<std::size_t>(looks);
  if (all.size() <= back) return std::nullopt;
  return all[all.size() - 1 - back];
}

double JudgedHalfWidth(const Estimated& statistic, std::size_t n, bool relative) {
  if (n == 0) return kInfinity;
  const double half_width =
      statistic.interval.HalfWidth() * (1.0 + kCorrection / static_cast<double>(n));
  if (!relative || half_width == 0.0) return half_width;
  return half_width / std::abs(statistic.value);
}

std::optional<std::size_t> StopsAt(std::span<const double> values, const StoppingRule& rule,
                                   const LookFunction& statistic) {
  for (std::size_t look = NextLook(0); look <= values.size(); look = NextLook(look)) {
    const Estimated estimated = statistic(values.first(look));
    if (JudgedHalfWidth(estimated, look, rule.relative) > rule.half_width) continue;
    std::size_t end = look;
    for (int i = 0; i < rule.more_looks; ++i) end = NextLook(end);
    return end <= values.size() ? std::optional(end) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace polnav::testbed
