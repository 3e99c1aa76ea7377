// Who may include what?
//
// Dependencies point one way: sky knows nobody; nav/api is the seam; sim and nav meet nowhere else;
// tools join them. The heavy libraries stay in the folders that exist for them.
#pragma once

#include <string>
#include <vector>

#include "tests/architecture/source_tree.h"

namespace polnav::architecture {

// What stands between the brackets or quotes of each #include, in order.
struct Include {
  std::string target;
  bool quoted = false;
};
[[nodiscard]] std::vector<Include> IncludesOf(const std::string& text);

// One sentence for each include line that breaks a rule.
[[nodiscard]] std::vector<std::string> IncludeViolations(const SourceFile& file);

}  // namespace polnav::architecture
