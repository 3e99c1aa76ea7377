#include "tools/polnav/overrides.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace polnav::testbed {

std::vector<ScenarioOverride> OverridesOf(const std::vector<std::string>& set,
                                          const std::optional<std::string>& seed,
                                          const std::optional<std::string>& duration_s,
                                          const std::vector<std::string>& estimators) {
  std::vector<ScenarioOverride> overrides;
  for (const std::string& change : set) overrides.push_back({change, "--set " + change});
  if (seed) overrides.push_back({"seed=" + *seed, "--seed " + *seed});
  if (duration_s) overrides.push_back({"duration_s=" + *duration_s, "--duration " + *duration_s});
  if (!estimators.empty()) {
    const std::string names = fmt::format("{}", fmt::join(estimators, ", "));
    overrides.push_back({"estimators.run=[" + names + "]", "--estimators " + names});
  }
  return overrides;
}

}  // namespace polnav::testbed
