// What a replay hears, and from when on.
#include "tools/testbed/dataset/replay.h"

#include <gtest/gtest.h>

#include "tests/testbed/dataset/dataset_files.h"
#include "tests/testbed/temporary_folder.h"
#include "tools/testbed/dataset/replay_settings.h"

namespace polnav::testbed {
namespace {

ReplayOutcome ReplayOf(const std::filesystem::path& folder) {
  Dataset dataset = OpenDataset(folder, {});
  const Scenario settings = ReplaySettings(dataset.info(), {});
  return Replay(std::move(dataset), settings, {});
}

// The first true pose is at 100 ms: until then there are 9 samples of the IMU (at 100 Hz, none at
// zero), 2 of polarimeter and reference (20 Hz), 4 of flow (50 Hz), one picture of each kind.
TEST(Replay, WhatComesBeforeTheFirstTruthIsPassedOver) {
  const TemporaryFolder folder;
  const Scenario scenario = SmallScenario();
  std::vector<DatasetItem> items = SmallRecording(scenario);
  ASSERT_TRUE(std::holds_alternative<sim::Truth>(items.front()));
  items.erase(items.begin());
  WriteRecording(folder.path(), scenario, items);
  const ReplayOutcome outcome = ReplayOf(folder.path());
  EXPECT_EQ(outcome.before_start, 9U + 2U + 2U + 4U + 1U + 1U);
  EXPECT_EQ(outcome.record.streams.at("imu").count, 50U - 9U);
  EXPECT_EQ(outcome.record.streams.at("stereo").count, 5U);
  EXPECT_EQ(outcome.record.truth.front().stamp, 100'000'000);
}

TEST(Replay, EveryStreamIsHeardAndTimed) {
  const TemporaryFolder folder;
  const Scenario scenario = SmallScenario();
  WriteRecording(folder.path(), scenario, SmallRecording(scenario));
  std::vector<double> fractions;
  Dataset dataset = OpenDataset(folder.path(), {});
  const Scenario settings = ReplaySettings(dataset.info(), {});
  const RunRecord record =
      Replay(std::move(dataset), settings, [&](double f) { fractions.push_back(f); }).record;
  EXPECT_EQ(record.streams.size(), 7U);
  EXPECT_EQ(record.timing.at("front_end").ms.size(), 6U);
  EXPECT_EQ(record.sim_duration_s, 0.5);
  EXPECT_EQ(fractions.front(), 0.0);
  EXPECT_EQ(fractions.back(), 1.0);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
}

}  // namespace
}  // namespace polnav::testbed
