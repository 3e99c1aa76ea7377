// result.json, the criteria judged on it, and what a build server reads.
#include "tools/testbed/result.h"

#include <gtest/gtest.h>

#include "tests/testbed/example_run.h"
#include "tools/testbed/metrics.h"

namespace polnav::testbed {
namespace {

class ResultTest : public ::testing::Test {
 protected:
  std::vector<CriterionResult> Judge(const std::vector<Criterion>& criteria) {
    scenario_.criteria = criteria;
    return EvaluateCriteria(scenario_, result_);
  }

  Scenario scenario_ = ParseScenario(ExampleScenarioYaml(), "s.yaml");
  RunRecord record_ = ExampleRun(scenario_, {.seed = 42}, nullptr);
  Json result_ = BuildResult(scenario_, record_, 42, "image");
};

TEST_F(ResultTest, CarriesWhatTheRunWas) {
  EXPECT_EQ(result_["scenario"], "example");
  EXPECT_EQ(result_["seed"], 42);
  EXPECT_EQ(result_["level"], "image");
  EXPECT_EQ(result_["real_time_factor"], 30.0);
  EXPECT_EQ(result_["scenario_sha256"].get<std::string>().size(), 64U);
  EXPECT_EQ(result_["streams"]["imu"]["count"], 6042);
  EXPECT_EQ(result_["timing_ms"]["render"]["median"], 2.0);
  const Json& stereo = result_["estimators"]["stereo"];
  EXPECT_NEAR(stereo["heading_deg"]["rmse"].get<double>(), 2.0, 1e-9);
  EXPECT_NEAR(stereo["position_m"]["rmse"].get<double>(), 0.5, 1e-9);
  EXPECT_NEAR(stereo["ate_m"]["rmse"].get<double>(), 0.0, 1e-9);  // the offset is aligned away
  EXPECT_EQ(stereo["tracked_fraction"], 1.0);
}

TEST_F(ResultTest, HasEveryMetricThatIsOffered) {
  // Some are of disturbed runs alone.
  record_.disturbed = {{.begin_s = 10.0, .end_s = 12.0}};
  result_ = BuildResult(scenario_, record_, 42, "image");
  for (const std::string& metric : AllMetrics()) {
    const std::string estimator = EstimatorOfMetric(metric);
    if (!estimator.empty() && !result_["estimators"].contains(estimator)) continue;
    EXPECT_TRUE(MetricAt(result_, metric).has_value()) << metric;
    EXPECT_TRUE(IsMetric(metric)) << metric;
  }
  EXPECT_FALSE(IsMetric("estimators.stereo.sha256"));
  EXPECT_FALSE(IsMetric("estimators.stereo"));
}

TEST_F(ResultTest, BoundsAreInclusiveAndBelowIsStrict) {
  const std::string count = "streams.imu.count";
  const auto verdicts = Judge({{.name = "a", .metric = count, .at_most = 6042},
                               {.name = "b", .metric = count, .at_most = 6041},
                               {.name = "c", .metric = count, .at_least = 6042},
                               {.name = "d", .metric = count, .at_least = 6043},
                               {.name = "e", .metric = count, .below = count},
                               {.name = "f", .metric = count, .at_most = 1e9, .at_least = 6043}});
  const std::vector<Verdict> expected{Verdict::kPassed, Verdict::kFailed, Verdict::kPassed,
                                      Verdict::kFailed, Verdict::kFailed, Verdict::kFailed};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(verdicts[i].verdict, expected[i]);
  EXPECT_FALSE(AllPassed(verdicts));
  EXPECT_EQ(verdicts[5].expected, "streams.imu.count <= 1000000000 and >= 6043");
}

TEST_F(ResultTest, AMetricThatTheRunDidNotYieldFails) {
  const auto verdicts =
      Judge({{.name = "a", .metric = "timing_ms.nothing.p99", .at_most = 1e9},
             {.name = "b", .metric = "wall_s", .below = "timing_ms.nothing.p99"}});
  EXPECT_EQ(verdicts[0].verdict, Verdict::kFailed);
  EXPECT_FALSE(verdicts[0].actual.has_value());
  EXPECT_EQ(verdicts[1].verdict, Verdict::kFailed);
}

TEST_F(ResultTest, AnEstimatorThatDivergedFailsItsCriteria) {
  record_.estimators[0].estimates[10].T_WB.p.x() = std::numeric_limits<double>::quiet_NaN();
  result_ = BuildResult(scenario_, record_, 42, "image");
  EXPECT_EQ(Judge({{.name = "a", .metric = "estimators.stereo.position_m.rmse", .at_most = 1e9}})[0]
                .verdict,
            Verdict::kFailed);
  EXPECT_NE(result_.dump().find("null"), std::string::npos);  // JSON has no NaN
}

TEST_F(ResultTest, AnEstimatorThatNeverAnsweredFailsItsCriteria) {
  record_.estimators[0].estimates.clear();
  result_ = BuildResult(scenario_, record_, 42, "image");
  EXPECT_EQ(
      Judge({{.name = "a", .metric = "estimators.stereo.tracked_fraction", .at_least = 0.5}})[0]
          .verdict,
      Verdict::kFailed);
}

// A compass has no position: neither metrics nor criteria speak of one.
TEST_F(ResultTest, ACompassIsScoredByItsHeadingAlone) {
  EstimatorRun& compass = record_.estimators[0];
  compass.heading_only = true;
  compass.counts = {.used = 3, .unusable = 1};
  result_ = BuildResult(scenario_, record_, 42, "image");
  EXPECT_TRUE(MetricAt(result_, "estimators.stereo.heading_deg.rmse").has_value());
  EXPECT_TRUE(MetricAt(result_, "estimators.stereo.nees.heading").has_value());
  EXPECT_FALSE(MetricAt(result_, "estimators.stereo.position_m.rmse").has_value());
  EXPECT_FALSE(MetricAt(result_, "estimators.stereo.ate_m.rmse").has_value());
  EXPECT_EQ(result_["estimators"]["stereo"]["tracked_fraction"], 0.75) << "share answered";
  EXPECT_TRUE(IsMetric("estimators.compass_stokes.heading_deg.rmse"));
  EXPECT_FALSE(IsMetric("estimators.compass_stokes.position_m.rmse"));
}

TEST_F(ResultTest, CriteriaOfEstimatorsLeftOutAreSkipped) {
  scenario_.estimators.run = {"stereo"};
  const auto verdicts =
      Judge({{.name = "a", .metric = "estimators.stereo.ate_m.rmse", .at_most = 1.0},
             {.name = "b", .metric = "estimators.stereo_polarization.ate_m.rmse", .at_most = 0.0}});
  EXPECT_EQ(verdicts[0].verdict, Verdict::kPassed);
  EXPECT_EQ(verdicts[1].verdict, Verdict::kSkipped);
  EXPECT_TRUE(AllPassed(verdicts));
}

TEST_F(ResultTest, JUnitCountsAndEscapes) {
  const auto verdicts = Judge({{.name = "a < b & \"c\"", .metric = "wall_s", .at_most = 1.0},
                               {.name = "d", .metric = "wall_s", .at_most = 3.0}});
  const std::string xml = JUnitXml(scenario_, result_, verdicts);
  EXPECT_NE(xml.find("tests=\"2\" failures=\"1\" errors=\"0\" skipped=\"0\""), std::string::npos);
  EXPECT_NE(xml.find("name=\"a &lt; b &amp; &quot;c&quot;\""), std::string::npos);
  EXPECT_NE(xml.find("<failure message=\"expected wall_s &lt;= 1, got 2\"/>"), std::string::npos);
  EXPECT_EQ(EscapeMarkup("\x01'\n"), "&#39;\n");
}

TEST_F(ResultTest, TheScenarioHashFollowsEveryOption) {
  Scenario other = scenario_;
  other.world.terrain.bump_m += 1e-9;
  const Json changed = BuildResult(other, record_, 42, "image");
  EXPECT_NE(changed["scenario_sha256"], result_["scenario_sha256"]);
}

}  // namespace
}  // namespace polnav::testbed
