// What the estimators say of their insides arrives in result.json and in the report.
#include "tools/testbed/diagnostics.h"

#include <gtest/gtest.h>

#include "tests/testbed/example_run.h"
#include "tools/testbed/disturbed_times.h"
#include "tools/testbed/report.h"
#include "tools/testbed/report/chart_data.h"
#include "tools/testbed/result.h"

namespace polnav::testbed {
namespace {

// Frame k has 100 points, k of them rejected in three ways, and one reading of the sky that is k
// tenths of a sigma off; the last one is gated.
Diagnostics TenFrames() {
  Diagnostics diagnostics;
  for (int k = 1; k <= 10; ++k) {
    const nav::TimeNs stamp = k * nav::kNsPerSecond / 10;
    diagnostics.Add({.features = 100,
                     .inliers = 100 - 3 * k,
                     .flow_rejected = k,
                     .pose_rejected = k,
                     .map_rejected = k,
                     .window_keyframes = 5,
                     .window_landmarks = 200 + k,
                     .vision_nis = 1.0 + 0.1 * k,
                     .sky = {{stamp, 0.001 * k, 0.01, k == 10}},
                     .estimate = nav::Estimate{.stamp = stamp}});
  }
  return diagnostics;
}

TEST(Diagnostics, SumsUpWhatTheFramesSaid) {
  const Json json = ToJson(TenFrames());
  EXPECT_EQ(json["frames"], 10);
  EXPECT_EQ(json["inliers"]["min"], 70.0);
  EXPECT_EQ(json["inliers"]["max"], 97.0);
  EXPECT_EQ(json["window_landmarks"]["median"], 205.5);
  EXPECT_DOUBLE_EQ(json["vision_nis"]["median"], 1.55);
  EXPECT_EQ(json["sky"]["readings"], 10);
  EXPECT_EQ(json["sky"]["gated"], 1);
  // The mean of k^2 / 100 for k from 1 to 9.
  EXPECT_NEAR(json["sky"]["nis"].get<double>(), 2.85 / 9.0, 1e-12);
  EXPECT_NEAR(json["sky"]["mean_deg"].get<double>(), nav::RadToDeg(0.005), 1e-12);
}

TEST(Diagnostics, AreNullOfAnEstimatorWithoutFrames) {
  Diagnostics compass;
  compass.Add({.outcome = nav::Outcome::kIgnored});
  EXPECT_TRUE(ToJson(compass).is_null());
}

TEST(Diagnostics, ReachResultAndReport) {
  const Scenario scenario = ParseScenario(ExampleScenarioYaml(), "s.yaml");
  RunRecord record = ExampleRun(scenario, {.seed = 42}, nullptr);
  record.estimators[1].diagnostics = TenFrames();
  const Json result = BuildResult(scenario, record, 42, "image");
  EXPECT_FALSE(result["estimators"]["stereo"].contains("diagnostics"));
  EXPECT_EQ(result["estimators"]["stereo_polarization"]["diagnostics"]["frames"], 10);
  const Json data = ChartData(record, scenario);
  EXPECT_TRUE(data["estimators"][0]["inside"].is_null());
  const Json& inside = data["estimators"][1]["inside"];
  EXPECT_EQ(inside["inliers"]["v"][9], 70);
  EXPECT_EQ(inside["map"]["t"][4], 0.5);
  EXPECT_EQ(inside["sky"]["used"]["v"].size(), 9U);
  EXPECT_EQ(inside["sky"]["gated"]["v"][0], 0.573);  // 0.01 rad in degrees, three digits
  // Two degrees, claimed sigma sqrt(1e-3) rad: (0.0349 / 0.0316)^2.
  EXPECT_EQ(data["estimators"][0]["nees"]["heading"]["v"][0], 1.22);
  const std::string html = HtmlReport({scenario, record, result, {}, "polnav run s.yaml"});
  for (const char* id : {"nees-heading", "nees-position", "features", "vision-nis", "rejected-1",
                         "window-1", "sky-1"}) {
    EXPECT_NE(html.find("<canvas id=\"" + std::string(id) + "\""), std::string::npos) << id;
  }
  EXPECT_EQ(html.find("<canvas id=\"rejected-0\""), std::string::npos);
}

// The car is 2 m/s fast on the road of 377 m: on metres 240 to 270 from 120 s to 135 s, and a lap
// (188.5 s) later again.
TEST(DisturbedTimes, AreWhenItHappensAndWhenTheCarIsThere) {
  Scenario scenario = ParseScenario(ExampleScenarioYaml(), "s.yaml");
  scenario.duration_s = 360.0;
  scenario.vehicle.car = sim::CarOptions{};
  sim::DisturbanceOptions fog{.start_s = 18.0, .duration_s = 6.0};
  fog.fog = sim::FogOptions{};
  sim::DisturbanceOptions walls;
  walls.low_features = sim::StretchOptions{.start_m = 240.0, .length_m = 30.0};
  scenario.disturbances = {fog, walls};
  const sim::Track track(scenario.world.track);
  std::vector<sim::Truth> truth;
  for (int i = 0; i <= 3600; ++i) {
    sim::Truth t{.stamp = i * nav::kNsPerSecond / 10};
    t.T_WB.p << track.At(0.2 * i).p_m, 0.0;
    truth.push_back(t);
  }
  const std::vector<Stretch> times = DisturbedTimes(scenario, 0, truth);
  ASSERT_EQ(times.size(), 3U);
  EXPECT_EQ(times[0].begin_s, 18.0);
  EXPECT_EQ(times[0].end_s, 24.0);
  for (const int lap : {0, 1}) {
    EXPECT_NEAR(times[1 + lap].begin_s, 120.0 + 188.5 * lap, 0.11);  // a truth every 0.1 s
    EXPECT_NEAR(times[1 + lap].end_s, 135.0 + 188.5 * lap, 0.11);
  }
}

}  // namespace
}  // namespace polnav::testbed
