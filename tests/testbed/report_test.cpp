// The report stands alone: one file, nothing to fetch, nothing from outside that could act in it.
#include "tools/testbed/report.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/testbed/example_run.h"

namespace polnav::testbed {
namespace {

std::string ExampleReport(Scenario scenario = ParseScenario(ExampleScenarioYaml(), "s.yaml")) {
  const RunRecord record = ExampleRun(scenario, {.seed = 42}, nullptr);
  const Json result = BuildResult(scenario, record, 42, "image");
  const auto criteria = EvaluateCriteria(scenario, result);
  return HtmlReport({scenario, record, result, criteria, "polnav run s.yaml"});
}

TEST(Report, FetchesNothing) {
  const std::string html = ExampleReport();
  for (const char* fetch : {"src=\"http", "src='http", "href=", "@import", "url(", "fetch(",
                            "XMLHttpRequest", "src=\"//", "importScripts", "WebSocket"}) {
    EXPECT_EQ(html.find(fetch), std::string::npos) << fetch;
  }
  // Every src is data.
  for (std::size_t at = html.find("src=\""); at != std::string::npos;
       at = html.find("src=\"", at + 1)) {
    EXPECT_EQ(html.substr(at, 27), "src=\"data:image/png;base64,");
  }
}

TEST(Report, ShowsThePaperBesideTheRun) {
  const std::string html = ExampleReport();
  EXPECT_NE(html.find("Chu2021: stereo + polarization"), std::string::npos);
  EXPECT_NE(html.find("21.58"), std::string::npos);
  EXPECT_NE(html.find(">2.000<"), std::string::npos);  // ours: two degrees
  Scenario without = ParseScenario(ExampleScenarioYaml(), "s.yaml");
  without.paper.clear();
  EXPECT_EQ(ExampleReport(without).find("Chu2021: "), std::string::npos);
}

TEST(Report, OfACompassSaysNothingOfPositions) {
  const Scenario scenario = ParseScenario(ExampleScenarioYaml(), "s.yaml",
                                          {{"paper=[Fan2020]", "test"}, {"criteria=[]", "test"}});
  RunRecord record = ExampleRun(scenario, {.seed = 42}, nullptr);
  for (EstimatorRun& run : record.estimators) run.heading_only = true;
  const Json result = BuildResult(scenario, record, 42, "image");
  const std::string html = HtmlReport({scenario, record, result, {}, "polnav run s.yaml"});
  EXPECT_NE(html.find("Fan2020: RANSAC + TLS, few clouds"), std::string::npos);
  EXPECT_EQ(html.find("Position error [m]"), std::string::npos);
  EXPECT_EQ(html.find("id=\"trajectory\""), std::string::npos);
}

// A walker's chart marks its steps, two a cycle of the gait; without an IMU there is no chart.
TEST(Report, ShowsWhatShakesTheImu) {
  EXPECT_EQ(ExampleReport().find("id=\"force\""), std::string::npos);
  Scenario scenario = ParseScenario(ExampleScenarioYaml(), "s.yaml");
  RunRecord record = ExampleRun(scenario, {.seed = 42}, nullptr);
  record.force = ForceLines{.step_hz = 0.5, .up_m_s2 = {0, 3, 1}, .ahead_m_s2 = {0, 1, 2}};
  const Json result = BuildResult(scenario, record, 42, "image");
  const auto report = [&] {
    return HtmlReport({scenario, record, result, {}, "polnav run s.yaml"});
  };
  EXPECT_NE(report().find("id=\"force\""), std::string::npos);
  EXPECT_NE(report().find("\"steps_hz\":null"), std::string::npos);
  scenario.vehicle = {};
  scenario.vehicle.hexapod.emplace().gait.cycle_s = 0.5;
  EXPECT_NE(report().find("\"steps_hz\":4.0"), std::string::npos);
}

TEST(Report, EscapesTextFromOutside) {
  Scenario scenario = ParseScenario(ExampleScenarioYaml(), "s.yaml");
  scenario.name = "</script><script>alert(1)</script>";
  const std::string html = ExampleReport(scenario);
  EXPECT_EQ(html.find("alert(1)</script>"), std::string::npos);
  EXPECT_EQ(html.find("<camera>"), std::string::npos);
}

TEST(Thin, KeepsEndsPeaksAndOrder) {
  std::vector<double> values(100'000, 0.0);
  values[12'345] = 9.0;
  values[77'777] = -9.0;
  const std::vector<std::size_t> kept = Thin(values, 2000);
  EXPECT_LE(kept.size(), 2000U);
  EXPECT_EQ(kept.front(), 0U);
  EXPECT_EQ(kept.back(), values.size() - 1);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  EXPECT_EQ(std::adjacent_find(kept.begin(), kept.end()), kept.end());
  EXPECT_NE(std::find(kept.begin(), kept.end(), 12'345U), kept.end());
  EXPECT_NE(std::find(kept.begin(), kept.end(), 77'777U), kept.end());
  EXPECT_EQ(Thin({1.0, 2.0}).size(), 2U);
  EXPECT_TRUE(Thin({}).empty());
}

}  // namespace
}  // namespace polnav::testbed
