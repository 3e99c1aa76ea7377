#include "tools/testbed/study/shard.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <string_view>

#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

std::optional<std::uint64_t> Number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}

std::uint64_t NumberIn(const Environment& environment, const std::string& name) {
  const std::optional<std::string> text = environment(name);
  if (!text) throw InputError("environment", 0, name, "is not set; give --shard K/N instead");
  const std::optional<std::uint64_t> value = Number(*text);
  if (!value) {
    throw InputError("environment", 0, name,
                     fmt::format("expected a whole number, got '{}'", *text));
  }
  return *value;
}

Shard SlurmShard(const Environment& environment) {
  const std::uint64_t id = NumberIn(environment, "SLURM_ARRAY_TASK_ID");
  const std::uint64_t count = NumberIn(environment, "SLURM_ARRAY_TASK_COUNT");
  const std::uint64_t min = NumberIn(environment, "SLURM_ARRAY_TASK_MIN");
  const std::uint64_t step =
      environment("SLURM_ARRAY_TASK_STEP") ? NumberIn(environment, "SLURM_ARRAY_TASK_STEP") : 1;
  if (step == 0 || id < min || (id - min) % step != 0 || (id - min) / step >= count) {
    throw InputError("environment", 0, "SLURM_ARRAY_TASK_ID",
                     fmt::format("task {} is none of {} tasks from {} in steps of {}: use an array "
                                 "without gaps, or give --shard K/N",
                                 id, count, min, step));
  }
  return {.index = (id - min) / step, .count = count};
}

}  // namespace

Shard ParseShard(const std::string& text, const std::string& source) {
  const std::size_t slash = text.find('/');
  const auto index = Number(std::string_view(text).substr(0, slash));
  const auto count =
      slash == std::string::npos ? std::nullopt : Number(std::string_view(text).substr(slash + 1));
  if (!index || !count || *count == 0) {
    throw InputError(source, 0, "", "expected K/N, such as 1/4: the first of four parts");
  }
  if (*index > *count) {
    throw InputError(source, 0, "",
                     fmt::format("there is no part {} of {}: K is at most N", *index, *count));
  }
  return {.index = *index % *count, .count = *count};
}

std::optional<std::string> ProcessEnvironment(const std::string& name) {
  const char* const value = std::getenv(name.c_str());
  return value == nullptr ? std::nullopt : std::optional<std::string>(value);
}

std::optional<Shard> ShardFromEnvironment(const Environment& environment) {
  if (environment("SLURM_ARRAY_TASK_ID")) return SlurmShard(environment);
  if (!environment("JOB_COMPLETION_INDEX")) return std::nullopt;
  const std::uint64_t index = NumberIn(environment, "JOB_COMPLETION_INDEX");
  const std::uint64_t count = NumberIn(environment, "JOB_COMPLETIONS");
  if (index >= count) {
    throw InputError("environment", 0, "JOB_COMPLETION_INDEX",
                     fmt::format("{} is not below JOB_COMPLETIONS, {}", index, count));
  }
  return Shard{.index = index, .count = count};
}

}  // namespace polnav::testbed
