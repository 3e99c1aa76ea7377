// A recording is as good as the run itself: the same estimates, to the last bit.
#include "tools/testbed/dataset/replay.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "tests/testbed/temporary_folder.h"
#include "tools/testbed/closed_loop.h"
#include "tools/testbed/dataset/replay_settings.h"

namespace polnav::testbed {
namespace {

void ExpectSame(const RunRecord& live, const RunRecord& replayed) {
  ASSERT_EQ(live.streams.size(), replayed.streams.size());
  for (const auto& [name, stream] : live.streams) {
    EXPECT_EQ(stream.count, replayed.streams.at(name).count) << name;
    EXPECT_EQ(stream.sha256, replayed.streams.at(name).sha256) << name;
  }
  ASSERT_EQ(live.estimators.size(), replayed.estimators.size());
  for (std::size_t i = 0; i < live.estimators.size(); ++i) {
    ASSERT_FALSE(live.estimators[i].estimates.empty());
    EXPECT_EQ(live.estimators[i].sha256, replayed.estimators[i].sha256) << live.estimators[i].name;
  }
}

class Replayed : public ::testing::Test {
 protected:
  RunRecord Live(const std::string& scenario, const std::string& duration_s,
                 std::vector<ScenarioOverride> overrides = {}) {
    overrides.push_back({"duration_s=" + duration_s, "test"});
    scenario_ = LoadScenario(std::string(POLNAV_SOURCE_DIR) + "/scenarios/" + scenario + ".yaml",
                             overrides);
    return RunClosedLoop(scenario_, {.seed = scenario_.seed, .record_folder = recording_}, {});
  }
  ReplayOutcome Replay(const std::vector<ScenarioOverride>& overrides = {}) {
    Dataset dataset = OpenDataset(recording_, {});
    const Scenario settings = ReplaySettings(dataset.info(), overrides);
    return testbed::Replay(std::move(dataset), settings, {});
  }

  TemporaryFolder folder_;
  std::filesystem::path recording_ = folder_.path() / "recording";
  Scenario scenario_;
};

TEST_F(Replayed, StereoImuAndPolarimeterWithFaults) {
  const RunRecord live =
      Live("five_laps", "3",
           {{"faults=[{sensor: stereo, start_s: 1, duration_s: 1, reorder: {probability: 0.5, "
             "hold_s: 0.3}}, {sensor: stereo, start_s: 2, corrupt: {share: 0.3}}, "
             "{sensor: imu, drift: {gyro_deg_s: [0, 0, 1]}}, {sensor: polarimeter, start_s: 0.5, "
             "drop: {probability: 0.3}}]",
             "test"},
            {"seed=11", "test"}});
  const ReplayOutcome outcome = Replay();
  EXPECT_FALSE(outcome.failure.has_value());
  EXPECT_TRUE(outcome.problems.empty());
  EXPECT_EQ(outcome.before_start, 0U);
  EXPECT_EQ(outcome.record.sim_duration_s, 3.0);
  ExpectSame(live, outcome.record);
}

TEST_F(Replayed, OpticalFlow) {
  const RunRecord live = Live("five_laps", "0.5", {{"sensors.optical_flow={}", "test"}});
  EXPECT_EQ(live.streams.at("flow").count, 25U);
  ExpectSame(live, Replay().record);
}

// What is recorded is what the sensors said, so that faults can come and go afterwards.
TEST_F(Replayed, FaultsAreNotInTheRecording) {
  const RunRecord calm = Live("five_laps", "1", {{"faults=[]", "test"}});
  const char* faults = "faults=[{sensor: stereo, start_s: 0.4, corrupt: {share: 0.5}}]";
  const RunRecord live = Live("five_laps", "1", {{faults, "test"}});
  ExpectSame(live, Replay().record);
  ExpectSame(calm, Replay({{"faults=[]", "test"}}).record);
  EXPECT_NE(live.estimators[0].sha256, calm.estimators[0].sha256);
}

// Its calibration comes from a turn before the run: that, too, is in the recording.
TEST_F(Replayed, SkyCameraWithItsCalibration) {
  const RunRecord live =
      Live("sky_few_clouds", "12", {{"estimators.calibrate_sky_camera=true", "test"}});
  ExpectSame(live, Replay().record);
}

TEST_F(Replayed, WithoutTruthTheStartIsTheOriginLookingNorth) {
  (void)Live("five_laps", "0.5");
  std::filesystem::remove_all(recording_ / "mav0" / "state_groundtruth_estimate0");
  const RunRecord record = Replay().record;
  EXPECT_TRUE(record.truth.empty());
  ASSERT_FALSE(record.estimators.at(0).estimates.empty());
  const nav::Pose& first = record.estimators[0].estimates.front().T_WB;
  EXPECT_LT(first.p.norm(), 1e-9);
  EXPECT_LT(std::abs(nav::CompassHeading(first.q)), 1e-9);
}

}  // namespace
}  // namespace polnav::testbed
