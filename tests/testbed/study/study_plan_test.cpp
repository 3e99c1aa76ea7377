// Study files: which trials they plan, and what is refused before anything runs.
#include "tools/testbed/study/study_plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "tests/testbed/study/study_fixture.h"
#include "tools/testbed/study/identity.h"

namespace polnav::testbed {
namespace {

constexpr const char* kSweep = R"(trials: 3
variants:
  - name: well
  - {name: dead, set: ["faults=[{sensor: polarimeter, start_s: 1, dead_channel: {}}]"]}
grid:
  sky.thin_cloud_cover: [0, 0.5]
  sky.model: [rayleigh, berry]
dispersions:
  - {key: sky.max_dop, uniform: {min: 0.5, max: 0.8}}
)";

TEST(StudyPlan, CasesAreScenariosTimesVariantsTimesTheGrid) {
  const StudyFolder folder;
  const StudyPlan plan = folder.Plan(kSweep);
  ASSERT_EQ(plan.cases().size(), 8U);
  EXPECT_EQ(plan.trial_count(), 24U);
  EXPECT_EQ(plan.cases()[0].label, "example, well, sky.thin_cloud_cover=0, sky.model=rayleigh");
  EXPECT_EQ(plan.cases()[7].label, "example, dead, sky.thin_cloud_cover=0.5, sky.model=berry");
  const Scenario last = plan.ScenarioOf(plan.At(7));
  EXPECT_EQ(last.sky.thin_cloud_cover, 0.5);
  EXPECT_EQ(last.sky.clear.model, "berry");
  EXPECT_EQ(last.faults.size(), 1U);
  EXPECT_TRUE(plan.ScenarioOf(plan.At(0)).faults.empty());
  EXPECT_EQ(plan.cases()[0].estimators,
            (std::vector<std::string>{"stereo", "stereo_polarization"}));
}

TEST(StudyPlan, CasesShareTheValuesOfASample) {
  const StudyFolder folder;
  const StudyPlan plan = folder.Plan(kSweep);
  for (std::uint64_t sample = 0; sample < 3; ++sample) {
    const double value = plan.ScenarioOf(plan.At(sample * 8)).sky.clear.max_dop;
    for (std::uint64_t c = 0; c < 8; ++c) {
      const PlannedTrial trial = plan.At(sample * 8 + c);
      EXPECT_EQ(trial.sample, sample);
      EXPECT_EQ(trial.case_id, c);
      EXPECT_EQ(plan.ScenarioOf(trial).sky.clear.max_dop, value);
    }
  }
}

TEST(StudyPlan, MoreTrialsGoOnWhereFewerEnded) {
  const StudyFolder folder;
  const std::string few = std::string(kTwoDispersions);
  const std::string many = "trials: 9\n" + few.substr(few.find('\n') + 1);
  for (const char* sampling : {"random", "sobol"}) {
    const std::string line = std::string("sampling: ") + sampling + "\n";
    const StudyPlan short_plan = folder.Plan(few + line);
    const StudyPlan long_plan = folder.Plan(many + line);
    EXPECT_EQ(short_plan.identity(), long_plan.identity());
    EXPECT_EQ(short_plan.At(3).inputs[1].text, long_plan.At(3).inputs[1].text);
  }
  const std::string line = "sampling: latin_hypercube\n";
  EXPECT_EQ(
      FirstDifference(folder.Plan(few + line).identity(), folder.Plan(many + line).identity()),
      "trials is 4 there and 9 here");
}

TEST(StudyPlan, TheIdentityIsOfWhatDecidesTheTrials) {
  const StudyFolder folder;
  const std::string lines = kTwoDispersions;
  const Json identity = folder.Plan(lines).identity();
  EXPECT_EQ(folder.Plan(lines + "description: other words\ntime_limit_s: 5\n").identity(),
            identity);
  EXPECT_EQ(FirstDifference(identity, folder.Plan(lines + "duration_s: 5\n").identity()),
            "its scenario has other values (cases.0.scenario_sha256)");
  std::string wider = lines;
  wider.replace(wider.find("0.05"), 4, "0.06");
  EXPECT_EQ(FirstDifference(identity, folder.Plan(wider).identity()),
            "dispersions.0.normal.sigma is 0.05 there and 0.06 here");
}

TEST(StudyPlan, RefusesKeysAndValuesThatNoScenarioTakes) {
  const StudyFolder folder;
  const auto error = [&](const std::string& entry) {
    return folder.ErrorOf("trials: 50\ndispersions:\n  - " + entry + "\n");
  };
  EXPECT_EQ(error("{key: sky.max_dob, uniform: {min: 0.5, max: 0.8}}"),
            "study.yaml:6: sky.max_dob: unknown key; did you mean 'max_dop'?");
  EXPECT_EQ(error("{key: sensors.stereo.width_px, uniform: {min: 300, max: 600}}").substr(0, 60),
            "study.yaml:6: sensors.stereo.width_px: expected a whole numb");
  EXPECT_EQ(error("{key: sky.max_dop, uniform: {min: 0.5, max: 1.2}}"),
            "study.yaml:6: dispersions.0: 1.2 may be drawn for sky.max_dop, out of range, [0, 1]");
  EXPECT_EQ(error("{key: sky.max_dop, discrete: {values: [0.5, 1.2], weights: [1, 0.0001]}}"),
            "study.yaml:6: dispersions.0: 1.2 may be drawn for sky.max_dop, out of range, [0, 1]");
  const std::string drawn = error("{key: sky.max_dop, normal: {mean: 0.9, sigma: 0.1}}");
  EXPECT_EQ(drawn.substr(0, 36), "study.yaml:6: dispersions.0: sample ");
  EXPECT_NE(drawn.find("for sky.max_dop, out of range, [0, 1]: cut the distribution off"),
            std::string::npos)
      << drawn;
  EXPECT_EQ(error("{key: sky.model, discrete: {values: [berry, bery]}}").substr(0, 55), "no error")
      << "a value that only some trials draw makes those invalid";
  EXPECT_EQ(folder.ErrorOf("grid: {sky.max_dop: [0.5, 1.5]}\n"),
            "study.yaml:4: sky.max_dop: 1.5 is out of range, [0, 1]");
  EXPECT_EQ(folder.ErrorOf("grid: {sky.max_dop: 0.5}\n"),
            "study.yaml:4: grid.sky.max_dop: expected a list of values, got '0.5'");
  EXPECT_EQ(folder.ErrorOf("set: [\"sky.modle=berry\"]\n"),
            "study.yaml:4: sky.modle: unknown key; did you mean 'model'?");
  EXPECT_EQ(folder.ErrorOf("grid: {sky.max_dop: [0.5]}\ndispersions:\n"
                           "  - {key: sky.max_dop, uniform: {min: 0.5, max: 0.8}}\n"),
            "study.yaml:6: dispersions.0: 'sky.max_dop' is varied twice");
}

TEST(StudyPlan, RefusesWhatNamesNothing) {
  const StudyFolder folder;
  EXPECT_EQ(folder.ErrorOf("trails: 4\n"),
            "study.yaml:4: trails: unknown key; did you mean "
            "'trials'?");
  EXPECT_EQ(folder.ErrorOf("trials: 0\n"),
            "study.yaml:4: trials: 0 is out of range, [1, 1000000000]");
  EXPECT_EQ(folder.ErrorOf("estimators: [sterio]\n").substr(0, 55),
            "study.yaml:4: estimators.run: 'sterio' is not one of: s");
  EXPECT_EQ(folder.ErrorOf("variants: [{name: a}, {name: a}]\n"),
            "study.yaml:4: variants.1: 'a' comes twice");
  std::ofstream(folder.File("other.yaml")) << "name: other\nscenarios: [none.yaml]\n";
  try {
    (void)LoadStudy(folder.File("other.yaml"));
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("other.yaml:2: scenarios.0: there is no file"),
              std::string::npos)
        << error.what();
  }
}

TEST(StudyPlan, RefusesCriteriaThatCannotBeJudged) {
  const StudyFolder folder;
  const auto error = [&](const std::string& criterion) {
    return folder.ErrorOf("criteria:\n  - " + criterion + "\n");
  };
  EXPECT_EQ(error("{name: c, estimator: stereo, metric: heading_deg.rmse, at_most: 1}"),
            "no error");
  EXPECT_EQ(error("{name: c, statistic: ok_rate, at_least: 1}"), "no error");
  EXPECT_EQ(error("{name: c, estimator: stereo, metric: heading_deg.rmes, at_most: 1}"),
            "study.yaml:5: criteria.0.metric: 'heading_deg.rmes' is no metric of 'stereo'; did you "
            "mean 'heading_deg.rmse'? (polnav list shows all)");
  EXPECT_EQ(error("{name: c, estimator: stereos, metric: heading_deg.rmse, at_most: 1}"),
            "study.yaml:5: criteria.0: estimator 'stereos' is not run in example; did you mean "
            "'stereo'?");
  EXPECT_EQ(error("{name: c, estimator: stereo, metric: heading_deg.rmse}"),
            "study.yaml:5: criteria.0: a criterion needs at_most, at_least or below");
  EXPECT_EQ(error("{name: c, scenario: moon, estimator: stereo, metric: ate_m.rmse, at_most: 1}"),
            "study.yaml:5: criteria.0: no case is of this scenario and variant");
  EXPECT_EQ(error("{name: c, estimator: stereo, metric: ate_m.rmse, statistic: success_rate, "
                  "at_least: 1}"),
            "study.yaml:5: criteria.0: success_rate needs success_at_most or success_at_least");
  for (const std::string statistic : {"min", "max"}) {
    EXPECT_EQ(error("{name: c, estimator: stereo, metric: ate_m.rmse, statistic: " + statistic +
                    ", at_most: 1, judge: interval}"),
              "study.yaml:5: criteria.0.judge: '" + statistic +
                  "' of the trials has no 95 % interval: use judge: value, or a percentile");
  }
  EXPECT_EQ(error("{name: c, estimator: stereo, metric: ate_m.rmse, statistic: p42, at_most: 1}")
                .substr(0, 60),
            "study.yaml:5: criteria.0.statistic: 'p42' is not one of: mea");
}

}  // namespace
}  // namespace polnav::testbed
