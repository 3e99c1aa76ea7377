// What does a study say, on a terminal?
#pragma once

#include <string>

#include "tools/testbed/option_tree.h"

namespace polnav::testbed {

// From the aggregate: each case's estimators with their 95 % intervals, comparisons, criteria. The
// first `most_cases` cases; a line says how many are left out.
[[nodiscard]] std::string StudySummary(const Json& aggregate, std::size_t most_cases = 12);

// The study's criteria, a line each: all, or those that fail.
[[nodiscard]] std::string StudyCriteriaText(const Json& aggregate, bool only_failures);

}  // namespace polnav::testbed
