// In what do two studies differ? For messages about files that do not belong together.
#pragma once

#include <string>

#include "tools/testbed/option_tree.h"

namespace polnav::testbed {

// "dispersions.0.normal.sigma is 0.1 there and 0.2 here"; empty when they are equal.
[[nodiscard]] std::string FirstDifference(const Json& there, const Json& here,
                                          const std::string& path = "");

}  // namespace polnav::testbed
