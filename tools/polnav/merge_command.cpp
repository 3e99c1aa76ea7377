#include <fmt/format.h>

#include <filesystem>

#include "tools/polnav/commands.h"
#include "tools/testbed/study/merge.h"

namespace polnav::testbed {

int Merge(const MergeArguments& arguments, const Console& console) {
  const MergeResult result = MergeStudies(
      arguments.out, {arguments.inputs.begin(), arguments.inputs.end()}, arguments.mix_builds);
  if (arguments.quiet) return kExitHolds;
  console.out << fmt::format("{}\n  {} trials added, {} were there already\n  {} of {} trials",
                             arguments.out, result.added, result.shared, result.present,
                             result.expected);
  std::string separator = ": ";
  for (const auto& [outcome, count] : result.outcomes) {
    console.out << fmt::format("{}{} {}", separator, count, NameOf(outcome));
    separator = ", ";
  }
  console.out << "\n  aggregate " << result.digest << "\n";
  return kExitHolds;
}

}  // namespace polnav::testbed
