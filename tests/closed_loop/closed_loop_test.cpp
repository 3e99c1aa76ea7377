// The whole chain with real images, twenty seconds of the five laps.
#include "tools/testbed/closed_loop.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "nav/api/geometry.h"
#include "tools/testbed/option_tree.h"
#include "tools/testbed/scenario.h"

namespace polnav::testbed {
namespace {

Scenario FiveLaps(const std::string& duration_s, std::vector<ScenarioOverride> overrides = {}) {
  overrides.push_back({"duration_s=" + duration_s, "test"});
  return LoadScenario(std::string(POLNAV_SOURCE_DIR) + "/scenarios/five_laps.yaml", overrides);
}

const RunRecord& TwentySeconds() {
  static const RunRecord record = RunClosedLoop(FiveLaps("20"), {.seed = 1}, {});
  return record;
}

TEST(ClosedLoop, BothEstimatorsFollowTheCar) {
  const RunRecord& record = TwentySeconds();
  ASSERT_EQ(record.estimators.size(), 2U);
  for (const EstimatorRun& run : record.estimators) {
    ASSERT_EQ(run.estimates.size(), record.truth.size()) << run.name;
    const auto tracked = std::count_if(run.estimates.begin(), run.estimates.end(),
                                       [](const nav::Estimate& e) { return e.tracked; });
    EXPECT_GE(static_cast<double>(tracked), 0.99 * static_cast<double>(run.estimates.size()));
    // 85 m driven: 1 % of it, and the granted heading's 0.3 degrees (three sigma) over 75 m.
    const Eigen::Vector3d error = run.estimates.back().T_WB.p - record.truth.back().T_WB.p;
    EXPECT_LT(error.norm(), 0.85 + 1.2) << run.name;
    const double heading = nav::WrapPi(nav::CompassHeading(run.estimates.back().T_WB.q) -
                                       nav::CompassHeading(record.truth.back().T_WB.q));
    EXPECT_LT(std::abs(heading), nav::DegToRad(1.2)) << run.name;
  }
}

TEST(ClosedLoop, TheTruthIsFarFromWhereItBegan) {
  const auto& truth = TwentySeconds().truth;
  EXPECT_GT((truth.back().T_WB.p - truth.front().T_WB.p).norm(), 60.0);
}

// Single readings are as bad as the paper's.
TEST(ClosedLoop, SinglePolarizationReadingsAreOffByDegrees) {
  double squares = 0.0;
  const auto& readings = TwentySeconds().polarization_readings;
  ASSERT_GT(readings.size(), 390U);
  for (const HeadingReading& r : readings) squares += r.error_rad * r.error_rad;
  const double rms_deg = nav::RadToDeg(std::sqrt(squares / static_cast<double>(readings.size())));
  EXPECT_GT(rms_deg, 0.7);
  EXPECT_LT(rms_deg, 2.5);
}

TEST(ClosedLoop, SameSeedSameBytesWithTwoRenderThreads) {
  const RunRecord one = RunClosedLoop(FiveLaps("4"), {.seed = 3, .render_threads = 1}, {});
  const RunRecord two = RunClosedLoop(FiveLaps("4"), {.seed = 3, .render_threads = 2}, {});
  ASSERT_EQ(one.streams.size(), 5U);
  for (const auto& [name, stream] : one.streams) {
    EXPECT_EQ(stream.sha256, two.streams.at(name).sha256) << name;
    EXPECT_EQ(stream.count, two.streams.at(name).count) << name;
  }
  for (std::size_t i = 0; i < one.estimators.size(); ++i) {
    EXPECT_EQ(one.estimators[i].sha256, two.estimators[i].sha256) << one.estimators[i].name;
  }
}

// The same from the command line, in a process of its own.
TEST(ClosedLoop, SameBytesInAFreshProcess) {
  const std::filesystem::path out =
      std::filesystem::temp_directory_path() / ("polnav_fresh_" + std::to_string(::getpid()));
  const std::string command = std::string(POLNAV_BINARY) + " run " + POLNAV_SOURCE_DIR +
                              "/scenarios/five_laps.yaml --seed 3 --duration 4 --quiet --out " +
                              out.string() + " >/dev/null 2>&1";
  (void)std::system(command.c_str());  // criteria of the whole drive may fail
  std::ifstream file(out / "result.json");
  ASSERT_TRUE(file) << command;
  const Json result = Json::parse(file);
  std::filesystem::remove_all(out);
  const RunRecord here = RunClosedLoop(FiveLaps("4"), {.seed = 3}, {});
  ASSERT_EQ(result["streams"].size(), here.streams.size());
  for (const auto& [name, stream] : here.streams) {
    EXPECT_EQ(result["streams"][name]["sha256"], stream.sha256) << name;
  }
}

// Pictures are lost, frozen, torn, late and in the wrong order, and a channel of the polarimeter
// dies.
TEST(ClosedLoop, FaultsLeaveOtherStreamsAloneAndEstimatesFinite) {
  const auto storm = [](const char* faults) {
    return RunClosedLoop(FiveLaps("6", {{std::string("faults=") + faults, "test"}}), {.seed = 3},
                         {});
  };
  const RunRecord calm = storm("[]");
  const RunRecord record = storm(
      "[{sensor: stereo, start_s: 1, duration_s: 1, stuck: {}},"
      " {sensor: stereo, start_s: 2, duration_s: 1, corrupt: {look: garbage_rows, share: 0.5}},"
      " {sensor: stereo, start_s: 3, duration_s: 1, reorder: {probability: 0.5, hold_s: 0.3}},"
      " {sensor: stereo, start_s: 4, duration_s: 1, off: {}},"
      " {sensor: polarimeter, start_s: 2, dead_channel: {}}]");
  for (const char* name : {"truth", "imu", "reference"}) {
    EXPECT_EQ(record.streams.at(name).sha256, calm.streams.at(name).sha256) << name;
  }
  for (const char* name : {"stereo", "polarimeter"}) {
    EXPECT_NE(record.streams.at(name).sha256, calm.streams.at(name).sha256) << name;
  }
  for (const EstimatorRun& run : record.estimators) {
    ASSERT_GT(run.estimates.size(), 30U) << run.name;
    for (const nav::Estimate& estimate : run.estimates) {
      ASSERT_TRUE(estimate.T_WB.p.allFinite() && estimate.T_WB.q.coeffs().allFinite() &&
                  estimate.covariance.allFinite())
          << run.name << " at " << nav::ToSeconds(estimate.stamp);
    }
  }
}

// The same drive without pictures: all other sensors say the same to the last bit, and the
// estimators follow as well as with pictures.
TEST(ClosedLoop, MeasurementLevelFollowsTheCarWithoutPictures) {
  const RunRecord record =
      RunClosedLoop(FiveLaps("20"), {.seed = 1, .level = sim::Level::kMeasurement}, {});
  EXPECT_FALSE(record.streams.contains("stereo"));
  EXPECT_EQ(record.streams.at("stereo_features").count, 201U);
  for (const char* name : {"truth", "imu", "polarimeter", "reference"}) {
    EXPECT_EQ(record.streams.at(name).sha256, TwentySeconds().streams.at(name).sha256) << name;
  }
  for (const EstimatorRun& run : record.estimators) {
    ASSERT_EQ(run.estimates.size(), record.truth.size()) << run.name;
    const Eigen::Vector3d error = run.estimates.back().T_WB.p - record.truth.back().T_WB.p;
    EXPECT_LT(error.norm(), 0.85 + 1.2) << run.name;
  }
}

// Sightings are dropped, and come again with new stamps: whoever is frozen is not followed.
TEST(ClosedLoop, FaultsOfTheStereoCameraActOnItsFeaturesAtMeasurementLevel) {
  const auto run = [](const char* faults) {
    const Scenario scenario = FiveLaps("6", {{std::string("faults=") + faults, "test"}});
    return RunClosedLoop(scenario, {.seed = 3, .level = sim::Level::kMeasurement}, {});
  };
  const RunRecord calm = run("[]");
  const RunRecord off = run("[{sensor: stereo, start_s: 2, duration_s: 1, off: {}}]");
  const RunRecord stuck = run("[{sensor: stereo, start_s: 2, duration_s: 1, stuck: {}}]");
  EXPECT_EQ(calm.streams.at("stereo_features").count, 61U);
  EXPECT_EQ(off.streams.at("stereo_features").count, 51U);
  EXPECT_EQ(stuck.streams.at("stereo_features").count, 61U);
  EXPECT_EQ(off.streams.at("imu").sha256, calm.streams.at("imu").sha256);
  EXPECT_EQ(stuck.estimators[0].counts.unusable, 10U);
  EXPECT_EQ(calm.estimators[0].counts.unusable, 0U);
}

TEST(ClosedLoop, WithoutTheImuTheOtherStreamsAreUnchanged) {
  const RunRecord with = RunClosedLoop(FiveLaps("3"), {.seed = 3}, {});
  const RunRecord without =
      RunClosedLoop(FiveLaps("3", {{"sensors.imu=null", "test"}}), {.seed = 3}, {});
  EXPECT_FALSE(without.streams.contains("imu"));
  for (const auto& [name, stream] : without.streams) {
    EXPECT_EQ(stream.sha256, with.streams.at(name).sha256) << name;
  }
}

// Eleven pictures of a turning sky camera: every compass answers by itself, and answers a heading.
TEST(ClosedLoop, CompassesReadTheSkyOnATurntable) {
  const Scenario scenario =
      LoadScenario(std::string(POLNAV_SOURCE_DIR) + "/scenarios/sky_few_clouds.yaml",
                   {{"duration_s=20", "test"}});
  const RunRecord record = RunClosedLoop(scenario, {.seed = 1}, {});
  EXPECT_EQ(record.streams.at("polarization_camera").count, 11U);
  ASSERT_EQ(record.estimators.size(), 3U);
  for (const EstimatorRun& run : record.estimators) {
    EXPECT_TRUE(run.heading_only);
    EXPECT_EQ(run.counts.used + run.counts.unusable, 11U) << run.name;
    EXPECT_EQ(run.counts.used, run.estimates.size()) << run.name;
    if (run.name != "compass_stokes") continue;
    EXPECT_EQ(run.estimates.size(), 11U);
    for (const nav::Estimate& e : run.estimates) {
      const auto truth = std::find_if(record.truth.begin(), record.truth.end(),
                                      [&](const sim::Truth& t) { return t.stamp == e.stamp; });
      const double error =
          nav::WrapPi(nav::CompassHeading(e.T_WB.q) - nav::CompassHeading(truth->T_WB.q));
      EXPECT_LT(std::abs(error), 5.0 * std::sqrt(e.covariance(5, 5)));
    }
  }
}

}  // namespace
}  // namespace polnav::testbed
