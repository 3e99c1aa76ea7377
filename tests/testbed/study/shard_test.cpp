// Shards: every trial belongs to one, whoever names it.
#include "tools/testbed/study/shard.h"

#include <gtest/gtest.h>

#include <map>

#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

Environment Of(const std::map<std::string, std::string>& variables) {
  return [variables](const std::string& name) {
    const auto found = variables.find(name);
    return found == variables.end() ? std::nullopt : std::optional(found->second);
  };
}

template <typename Action>
std::string ErrorOf(const Action& action) {
  try {
    (void)action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Shard, EveryTrialBelongsToExactlyOne) {
  for (const auto& parts : {std::vector<std::string>{"1/3", "2/3", "3/3"}, {"0/3", "1/3", "2/3"}}) {
    for (std::uint64_t trial = 0; trial < 20; ++trial) {
      int holders = 0;
      for (const std::string& part : parts) holders += ParseShard(part, "").Holds(trial) ? 1 : 0;
      EXPECT_EQ(holders, 1) << trial;
    }
  }
}

TEST(Shard, RefusesPartsThatThereAreNot) {
  const auto error = [](const std::string& text) {
    return ErrorOf([&] { return ParseShard(text, "--shard " + text); });
  };
  EXPECT_EQ(error("4/3"), "--shard 4/3: there is no part 4 of 3: K is at most N");
  for (const char* text : {"", "1", "/", "1/", "/2", "a/2", "1/2/3", "-1/2", "1/0", "1.5/2"}) {
    EXPECT_NE(error(text).find("expected K/N"), std::string::npos) << text;
  }
}

TEST(Shard, ATaskOfASlurmArrayKnowsItsPart) {
  const auto shard = ShardFromEnvironment(Of({{"SLURM_ARRAY_TASK_ID", "17"},
                                              {"SLURM_ARRAY_TASK_COUNT", "5"},
                                              {"SLURM_ARRAY_TASK_MIN", "11"},
                                              {"SLURM_ARRAY_TASK_STEP", "3"}}));
  ASSERT_TRUE(shard.has_value());
  EXPECT_EQ(shard->index, 2U);
  EXPECT_EQ(shard->count, 5U);
}

TEST(Shard, AnArrayWithGapsMakesNoWhole) {
  // --array=0,1,7: three tasks, of which the last would be number 7.
  EXPECT_NE(ErrorOf([] {
              return ShardFromEnvironment(Of({{"SLURM_ARRAY_TASK_ID", "7"},
                                              {"SLURM_ARRAY_TASK_COUNT", "3"},
                                              {"SLURM_ARRAY_TASK_MIN", "0"}}));
            }).find("use an array without gaps"),
            std::string::npos);
}

TEST(Shard, APodOfAnIndexedJobKnowsItsPart) {
  const auto shard =
      ShardFromEnvironment(Of({{"JOB_COMPLETION_INDEX", "3"}, {"JOB_COMPLETIONS", "4"}}));
  EXPECT_EQ(shard->index, 3U);
  EXPECT_EQ(shard->count, 4U);
  EXPECT_EQ(ErrorOf([] {
              return ShardFromEnvironment(Of({{"JOB_COMPLETION_INDEX", "3"}}));
            }),
            "environment: JOB_COMPLETIONS: is not set; give --shard K/N instead");
  EXPECT_FALSE(ShardFromEnvironment(Of({})).has_value());
}

}  // namespace
}  // namespace polnav::testbed
