// Shards of a study into one file.
//
// Idempotent: what is there already is left alone. Trials that are in several files must be equal
// there; one that went ok takes the place of one that did not. All or nothing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tools/testbed/study/schema.h"

namespace polnav::testbed {

struct MergeResult {
  std::uint64_t added = 0;
  std::uint64_t shared = 0;    // were in the target, or in several inputs
  std::uint64_t present = 0;   // in the target afterwards
  std::uint64_t expected = 0;  // in a complete study
  std::map<Outcome, std::uint64_t> outcomes;
  std::string digest;
};

// out is made when there is no such file. Throws InputError: files of different studies, trials
// that contradict each other; files whose trials different code has run, unless mix_builds.
[[nodiscard]] MergeResult MergeStudies(const std::filesystem::path& out,
                                       const std::vector<std::filesystem::path>& inputs,
                                       bool mix_builds = false);

}  // namespace polnav::testbed
