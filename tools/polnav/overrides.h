// What do the options of a command change in a scenario?
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/testbed/scenario.h"

namespace polnav::testbed {

// --set first, so that the options of their own win.
[[nodiscard]] std::vector<ScenarioOverride> OverridesOf(
    const std::vector<std::string>& set, const std::optional<std::string>& seed,
    const std::optional<std::string>& duration_s, const std::vector<std::string>& estimators);

}  // namespace polnav::testbed
