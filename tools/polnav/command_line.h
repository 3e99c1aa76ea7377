// What did the user ask for on the command line?
//
// Exit codes of every command: 0 all criteria hold, 1 a criterion failed, 2 bad input or usage,
// 3 crash.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/polnav/console.h"
#include "tools/testbed/closed_loop.h"

namespace polnav::testbed {

inline constexpr int kExitHolds = 0;
inline constexpr int kExitCriterionFailed = 1;
inline constexpr int kExitBadInput = 2;
inline constexpr int kExitCrash = 3;

using ClosedLoop = std::function<RunRecord(const Scenario&, const RunOptions&,
                                           const std::function<void(double)>&)>;

// arguments: without the program's name. Throws nothing; returns the exit code.
[[nodiscard]] int RunCommandLine(const std::vector<std::string>& arguments, const Console& console,
                                 const ClosedLoop& closed_loop);

}  // namespace polnav::testbed
