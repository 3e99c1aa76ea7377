// Which part of a study falls to this process?
//
// Shard K/N holds the trials with trial mod N = K mod N. K counts from 1 to N or from 0 to N - 1:
// 0/N and N/N are the same shard.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace polnav::testbed {

struct Shard {
  std::uint64_t index = 0;  // below count
  std::uint64_t count = 1;

  [[nodiscard]] bool Holds(std::uint64_t trial) const { return trial % count == index; }
};

// "K/N". source: how the user said it. Throws InputError for K > N and what is no such text.
[[nodiscard]] Shard ParseShard(const std::string& text, const std::string& source);

// Nothing when a variable is not set.
using Environment = std::function<std::optional<std::string>(const std::string& name)>;
[[nodiscard]] std::optional<std::string> ProcessEnvironment(const std::string& name);

// What a task of a Slurm array (SLURM_ARRAY_TASK_ID, _COUNT, _MIN, _STEP) or a pod of an indexed
// Kubernetes job (JOB_COMPLETION_INDEX, and JOB_COMPLETIONS, which the manifest sets) should do;
// nothing elsewhere. Throws InputError when the variables make no whole.
[[nodiscard]] std::optional<Shard> ShardFromEnvironment(const Environment& environment);

}  // namespace polnav::testbed
