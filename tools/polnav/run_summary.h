// How does a run end on the terminal? Errors beside the paper's, criteria, speed.
#pragma once

#include <string>
#include <vector>

#include "tools/testbed/option_tree.h"
#include "tools/testbed/result.h"
#include "tools/testbed/scenario.h"

namespace polnav::testbed {

[[nodiscard]] std::string RunSummary(const Scenario& scenario, const Json& result,
                                     const std::vector<CriterionResult>& criteria);

// One line a failed criterion.
[[nodiscard]] std::string FailureLines(const std::vector<CriterionResult>& criteria);

}  // namespace polnav::testbed
