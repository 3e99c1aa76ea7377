// The whole chain of the walking hexapod, at measurement level.
#include <gtest/gtest.h>

#include "tools/testbed/closed_loop.h"
#include "tools/testbed/scenario.h"
#include "tools/testbed/score.h"

namespace polnav::testbed {
namespace {

Scenario Wander() {
  return LoadScenario(std::string(POLNAV_SOURCE_DIR) + "/scenarios/hexapod_wander.yaml",
                      {{"duration_s=20", "test"}}, sim::Level::kMeasurement);
}

RunRecord Walk(std::uint64_t trial, sim::MotionMemory& motions) {
  return RunClosedLoop(
      Wander(), {.seed = 1, .trial = trial, .level = sim::Level::kMeasurement, .motions = &motions},
      {});
}

const EstimatorRun& Of(const RunRecord& record, const std::string& name) {
  for (const EstimatorRun& run : record.estimators) {
    if (run.name == name) return run;
  }
  throw std::logic_error("no estimator " + name);
}

// Half of Zeng2020's figures for a minute, in each of ten walks of 20 s. Trials 39 and 43 have
// accelerometer biases of two to three sigma, from which a filter must find its way.
TEST(ClosedLoopHexapod, TheSkyKeepsTheWalkersHeading) {
  sim::MotionMemory motions;
  for (const std::uint64_t trial : {0U, 1U, 2U, 3U, 13U, 30U, 31U, 39U, 41U, 43U}) {
    const RunRecord record = Walk(trial, motions);
    const auto score = Score(TrajectoryOf(record.truth), Of(record, "ukf").estimates);
    ASSERT_TRUE(score) << trial;
    EXPECT_LT(score->position_m->error.rmse, 0.05) << trial;
    EXPECT_LT(score->heading_deg.rmse, nav::RadToDeg(0.025)) << trial;
  }
}

TEST(ClosedLoopHexapod, SameBytesWithAndWithoutARememberedMotion) {
  sim::MotionMemory motions;
  const RunRecord first = Walk(0, motions);
  const RunRecord again = Walk(0, motions);
  const RunRecord alone =
      RunClosedLoop(Wander(), {.seed = 1, .level = sim::Level::kMeasurement}, {});
  for (std::size_t i = 0; i < first.estimators.size(); ++i) {
    EXPECT_EQ(first.estimators[i].sha256, again.estimators[i].sha256);
    EXPECT_EQ(first.estimators[i].sha256, alone.estimators[i].sha256);
  }
  EXPECT_NE(first.estimators[0].sha256, Walk(1, motions).estimators[0].sha256);
}

}  // namespace
}  // namespace polnav::testbed
