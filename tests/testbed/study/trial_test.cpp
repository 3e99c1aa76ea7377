// One trial: its outcome, its metrics, its errors over time.
#include "tools/testbed/study/trial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <new>
#include <opencv2/core.hpp>

#include "tests/testbed/study/study_fixture.h"

namespace polnav::testbed {
namespace {

std::optional<double> MetricOf(const TrialRecord& record, const std::string& estimator,
                               const std::string& path) {
  for (const TrialScore& score : record.scores) {
    if (score.estimator != estimator) continue;
    for (const auto& [name, value] : score.metrics) {
      if (name == path) return value;
    }
  }
  return std::nullopt;
}

class Trial : public ::testing::Test {
 protected:
  StudyFolder folder_;
  StudyPlan plan_ = folder_.Plan(kTwoDispersions);
};

TEST_F(Trial, KeepsTheMetricsOfResultJsonByTheirPaths) {
  const TrialRecord record = RunTrial(plan_, 2, DrawnRun);
  EXPECT_EQ(record.outcome, Outcome::kOk);
  ASSERT_EQ(record.scores.size(), 3U);
  EXPECT_EQ(MetricOf(record, "", "sim_duration_s"), 2.0);
  EXPECT_EQ(MetricOf(record, "", "streams.imu.count"), 2.0);
  EXPECT_EQ(MetricOf(record, "stereo", "position_m.count"), 21.0);
  EXPECT_TRUE(MetricOf(record, "stereo", "heading_deg.rmse").has_value());
  EXPECT_EQ(MetricOf(record, "stereo", "measurements.used"), 0.0);
  EXPECT_EQ(*MetricOf(record, "", "criteria.passed") + *MetricOf(record, "", "criteria.failed"),
            2.0);
  EXPECT_EQ(record.scores[1].sha256.size(), 64U);
  EXPECT_EQ(record.streams_sha256.size(), 64U);
}

TEST_F(Trial, SurvivesItsJourneyBetweenProcesses) {
  const TrialRecord record = RunTrial(plan_, 2, DrawnRun);
  const TrialRecord back = FromCbor(ToCbor(record));
  EXPECT_EQ(RecordSha256(back), RecordSha256(record));
  EXPECT_EQ(back.wall_s, record.wall_s);
  EXPECT_EQ(back.inputs[0].number, record.inputs[0].number);
  EXPECT_EQ(back.scores[1].series.heading_deg, record.scores[1].series.heading_deg);
}

TEST_F(Trial, ItsHashIsOfResultsAndNotOfTheMachine) {
  TrialRecord record = RunTrial(plan_, 2, DrawnRun);
  const std::string sha256 = RecordSha256(record);
  record.wall_s += 1.0;
  record.peak_rss_mb += 1.0;
  record.detail = "words";
  EXPECT_EQ(RecordSha256(record), sha256);
  record.scores[1].metrics[0].second = std::nextafter(record.scores[1].metrics[0].second, 1e9);
  EXPECT_NE(RecordSha256(record), sha256);
}

TEST_F(Trial, WhatIsThrownIsAnOutcome) {
  const auto outcome = [&](const ClosedLoopFunction& loop) {
    return RunTrial(plan_, 0, loop).outcome;
  };
  const auto throwing = [](const auto& error) {
    return [error](const Scenario&, const RunOptions&, const auto&) -> RunRecord { throw error; };
  };
  EXPECT_EQ(outcome(throwing(std::runtime_error("x"))), Outcome::kFailed);
  EXPECT_EQ(outcome(throwing(std::bad_alloc())), Outcome::kOutOfMemory);
  EXPECT_EQ(outcome(throwing(cv::Exception(cv::Error::StsNoMem, "", "", "", 0))),
            Outcome::kOutOfMemory);
  EXPECT_EQ(outcome(throwing(cv::Exception(cv::Error::StsBadArg, "", "", "", 0))),
            Outcome::kFailed);
  EXPECT_EQ(RunTrial(plan_, 0, throwing(std::runtime_error("x"))).detail, "x");
}

TEST(TrialSeries, HoldsTheNewestErrorAtOrBeforeEachInstant) {
  ErrorSeries errors;
  errors.t_s = {0.3, 1.0, 1.4};
  errors.heading_deg = {1.0, -2.0, 3.0};
  errors.position_m = {0.1, 0.2, 0.3};
  const TrialSeries series = SampleErrors(errors, 2.0, 5);  // at 0, 0.5, 1, 1.5, 2
  EXPECT_TRUE(std::isnan(series.heading_deg[0]));
  EXPECT_TRUE(std::isnan(series.position_m[0]));
  EXPECT_EQ((std::vector<float>(series.heading_deg.begin() + 1, series.heading_deg.end())),
            (std::vector<float>{1.0F, -2.0F, 3.0F, 3.0F}));
  EXPECT_EQ(series.position_m[3], 0.3F);
  errors.position_m.clear();
  EXPECT_TRUE(SampleErrors(errors, 2.0, 5).position_m.empty()) << "a compass knows no position";
}

}  // namespace
}  // namespace polnav::testbed
