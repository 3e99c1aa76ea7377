// Which code is this polnav made of?
//
// Results are only the same for the same code. Found out by git at each build (build_id.cmake);
// "unknown" where there is no repository.
#pragma once

#include <string>

namespace polnav::testbed {

struct BuildId {
  std::string commit;  // for people; "-changed" when files differ from it
  std::string code;    // hash of the folders that decide results, changes included
};

[[nodiscard]] BuildId ThisBuild();

}  // namespace polnav::testbed
