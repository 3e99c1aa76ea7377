// What ran ahead of a look does not count, in whatever order trials finish.
#include "tools/testbed/study/stop_gate.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sim/random.h"

namespace polnav::testbed {
namespace {

TrialRecord Record(std::uint64_t trial) {
  TrialRecord record;
  record.trial = trial;
  return record;
}

struct Passed {
  std::vector<std::uint64_t> trials;  // written, in order
  std::vector<std::uint64_t> looks;
  std::optional<std::uint64_t> ended_at;
};

// Hands over all trials of 400 samples of two cases in blocks that are shuffled within.
Passed Pass(std::size_t block, std::uint64_t ends_at, std::vector<bool> written) {
  Passed passed;
  std::vector<std::uint64_t> order;
  for (std::uint64_t trial = 0; trial < written.size(); ++trial) {
    if (!written[trial]) order.push_back(trial);
  }
  sim::RandomStream::Sample draw = sim::RandomStream(3, block, "order").At(0);
  for (std::size_t first = 0; first < order.size(); first += block) {
    for (std::size_t i = first; i < std::min(first + block, order.size()); ++i) {
      std::swap(order[i], order[first + draw.Bits() % (i - first + 1)]);
    }
  }
  StopGate gate(2, std::move(written), [&](std::uint64_t samples) {
    passed.looks.push_back(samples);
    return samples >= ends_at;
  });
  for (const std::uint64_t trial : order) {
    gate.Add(Record(trial));
    for (auto records = gate.Take(); !records.empty(); records = gate.Take()) {
      for (const TrialRecord& record : records) passed.trials.push_back(record.trial);
      gate.Written(records);
    }
  }
  std::sort(passed.trials.begin(), passed.trials.end());
  passed.ended_at = gate.ended_at();
  return passed;
}

TEST(StopGate, LetsThroughTheSameTrialsInWhateverOrderTheyFinish) {
  for (const std::size_t block : {1U, 7U, 60U, 800U}) {
    const Passed passed = Pass(block, 150, std::vector<bool>(800, false));
    EXPECT_EQ(passed.looks, (std::vector<std::uint64_t>{100, 125, 157})) << block;
    EXPECT_EQ(passed.ended_at, 157U);
    ASSERT_EQ(passed.trials.size(), 314U);
    EXPECT_EQ(passed.trials.back(), 313U);
  }
}

TEST(StopGate, GoesOnFromWhatIsInTheFile) {
  std::vector<bool> written(800, false);
  for (std::size_t i = 0; i < 270; ++i) written[i] = i != 40;
  const Passed passed = Pass(30, 150, written);
  EXPECT_EQ(passed.looks, (std::vector<std::uint64_t>{100, 125, 157}));
  EXPECT_EQ(passed.trials.size(), 314U - 269U);
  EXPECT_EQ(Pass(30, 150, std::vector<bool>(800, true)).ended_at, 157U) << "nothing is left to run";
}

TEST(StopGate, RunsToTheLastTrialWhenNoLookIsEnough) {
  const Passed passed = Pass(60, 1000, std::vector<bool>(800, false));
  EXPECT_EQ(passed.looks.back(), 387U);
  EXPECT_EQ(passed.trials.size(), 800U);
  EXPECT_FALSE(passed.ended_at.has_value());
}

TEST(StopGate, WithoutLooksEverythingPassesAtOnce) {
  StopGate gate(2, std::vector<bool>(800, false), {});
  gate.Add(Record(799));
  EXPECT_EQ(gate.Take().size(), 1U);
  gate.Written({Record(799)});
  EXPECT_FALSE(gate.ended_at().has_value());
}

}  // namespace
}  // namespace polnav::testbed
