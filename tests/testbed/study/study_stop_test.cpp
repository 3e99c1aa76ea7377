// A study that ends when its mean is known well enough: always after the same trials.
#include "tools/testbed/study/study_stop.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/testbed/study/study_fixture.h"
#include "tools/polnav/study_summary.h"
#include "tools/testbed/input_error.h"
#include "tools/testbed/report/study_report.h"
#include "tools/testbed/study/aggregate.h"
#include "tools/testbed/study/study_run.h"

namespace polnav::testbed {
namespace {

// A trial's heading error is |N| of 0.8 degrees: its mean over n scatters by 0.49 / sqrt(n), known
// to within 0.07 degrees after about 190.
constexpr const char* kStop = R"(trials: 600
seed: 5
grid: {sky.thin_cloud_cover: [0, 0.5]}
stop:
  - {estimator: stereo, metric: heading_deg.rmse, half_width: 0.07}
)";

class StudyStopping : public ::testing::Test {
 protected:
  StudyRunResult Run(const std::string& name, int jobs = 1,
                     const ClosedLoopFunction& loop = DrawnRun) {
    return Run(plan_, name, jobs, loop);
  }
  StudyRunResult Run(const StudyPlan& plan, const std::string& name, int jobs = 1,
                     const ClosedLoopFunction& loop = DrawnRun) {
    return RunStudy(plan, {.jobs = jobs, .out = folder_.File(name), .study_file = "s.yaml"}, loop,
                    [](const StudyCounts&) {});
  }
  [[nodiscard]] Json AggregateOf(const std::string& name) const {
    StudyDatabase study = StudyDatabase::OpenToRead(folder_.File(name));
    return Aggregate(study.connection());
  }

  StudyFolder folder_;
  StudyPlan plan_ = folder_.Plan(kStop);
};

// Uneven trials, so that two workers get out of step.
RunRecord UnevenRun(const Scenario& scenario, const RunOptions& options,
                    const std::function<void(double)>& progress) {
  ::usleep(options.trial % 7 == 3 ? 4000 : 200);
  return DrawnRun(scenario, options, progress);
}

TEST_F(StudyStopping, EndsAfterTheSameTrialsForOneJobAndTwo) {
  const StudyRunResult one = Run("one");
  EXPECT_LT(one.counts.total, 1200U) << "it stopped";
  EXPECT_GT(one.counts.total, 200U) << "not at the first look";
  EXPECT_EQ(one.counts.done, one.counts.total);
  EXPECT_EQ(one.outcomes.at(Outcome::kOk), one.counts.total);
  for (const int jobs : {2, 3}) {
    const StudyRunResult more = Run("more" + std::to_string(jobs), jobs, UnevenRun);
    EXPECT_EQ(more.digest, one.digest) << jobs;
    EXPECT_EQ(AggregateText(folder_.File("more" + std::to_string(jobs))),
              AggregateText(folder_.File("one")));
  }
  EXPECT_EQ(Run("one").counts.resumed, one.counts.total) << "nothing more to run";
}

TEST_F(StudyStopping, EndsAfterTheSameTrialsWhenItWasKilled) {
  const StudyRunResult whole = Run("whole");
  for (const useconds_t after_us : {60'000U, 200'000U, 330'000U}) {
    const pid_t child = ::fork();
    if (child == 0) {
      (void)Run("killed", 2, UnevenRun);
      ::_exit(0);
    }
    ::usleep(after_us);
    ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
  }
  const StudyRunResult rest = Run("killed", 2, UnevenRun);
  EXPECT_EQ(rest.digest, whole.digest);
  EXPECT_EQ(AggregateText(folder_.File("killed")), AggregateText(folder_.File("whole")));
}

TEST_F(StudyStopping, SaysWhyItStopped) {
  const StudyRunResult result = Run("why");
  const Json aggregate = AggregateOf("why");
  const Json& stop = aggregate["stop"];
  EXPECT_EQ(stop["stopped_at"], result.counts.total / 2) << "of two cases";
  EXPECT_TRUE(aggregate["complete"].get<bool>());
  ASSERT_EQ(stop["checks"].size(), 2U) << "known in each case";
  for (const Json& check : stop["checks"]) {
    EXPECT_TRUE(check["known"].get<bool>());
    EXPECT_LE(check["half_width"].get<double>(), 0.07);
  }
  EXPECT_NE(StudySummary(aggregate).find("trials of each case, known well enough"),
            std::string::npos);
  StudyDatabase study = StudyDatabase::OpenToRead(folder_.File("why"));
  const std::string html = StudyHtml(StudyTable(study.connection()), aggregate);
  EXPECT_NE(html.find("<h2>Why it stopped</h2>"), std::string::npos);
}

TEST_F(StudyStopping, RunsToItsLastTrialWhenThatIsNotEnough) {
  std::string lines = kStop;
  lines.replace(lines.find("600"), 3, "130");
  EXPECT_EQ(Run(folder_.Plan(lines), "few").counts.done, 260U);
  const Json aggregate = AggregateOf("few");
  EXPECT_TRUE(aggregate["stop"]["stopped_at"].is_null());
  EXPECT_EQ(aggregate["stop"]["looked_at"], 125);
  EXPECT_TRUE(aggregate["complete"].get<bool>());
  // With more trials allowed it goes on to where it would have stopped at once.
  EXPECT_EQ(Run("few").digest, Run("whole").digest);
}

TEST_F(StudyStopping, PairsMediansAndSharesCanBeAskedFor) {
  const StudyPlan plan = folder_.Plan(R"(trials: 2000
stop:
  - {estimator: stereo, minus: stereo_polarization, metric: heading_deg.rmse, half_width: 0.1}
  - {estimator: stereo, metric: heading_deg.rmse, statistic: median, relative_half_width: 0.2}
  - {estimator: stereo, metric: heading_deg.rmse, statistic: success_rate, success_at_most: 1.5,
     half_width: 0.05}
)");
  EXPECT_LT(Run(plan, "three").counts.total, 2000U);
  const Json stop = AggregateOf("three")["stop"];
  ASSERT_EQ(stop["checks"].size(), 3U);
  EXPECT_EQ(stop["checks"][0]["what"],
            "stereo heading_deg.rmse mean of the difference to stereo_polarization");
  EXPECT_LE(stop["checks"][2]["half_width"].get<double>(), 0.05);
}

TEST_F(StudyStopping, AFailedTrialIsNoValue) {
  const ClosedLoopFunction faulty = [](const Scenario& s, const RunOptions& o, const auto& p) {
    if (o.trial % 10 == 4) throw std::runtime_error("the wheel came off");
    return DrawnRun(s, o, p);
  };
  (void)Run("faulty", 2, faulty);
  const Json check = AggregateOf("faulty")["stop"]["checks"][0];
  const auto samples = AggregateOf("faulty")["stop"]["looked_at"].get<int>();
  EXPECT_EQ(check["n"], samples - (samples + 5) / 10);
}

TEST_F(StudyStopping, AShardIsRefused) {
  try {
    (void)RunStudy(plan_,
                   {.shard = {.index = 1, .count = 2}, .out = folder_.File("s"), .study_file = "f"},
                   DrawnRun, [](const StudyCounts&) {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "f: stop: a look sees all trials before it, and a shard (1 of 2) has only its "
                 "own: run the study without shards, or without stop");
  }
  EXPECT_FALSE(std::filesystem::exists(folder_.File("s")));
}

TEST(StudyStopFile, RefusesWhatHasNoValidIntervalAtALook) {
  const StudyFolder folder;
  const auto error = [&](const std::string& entry, const std::string& more = "trials: 500\n") {
    return folder.ErrorOf(more + "stop:\n  - " + entry + "\n");
  };
  const std::string good = "{estimator: stereo, metric: heading_deg.rmse, half_width: 0.1}";
  EXPECT_EQ(error(good), "no error");
  EXPECT_EQ(error(good, "trials: 500\nsampling: sobol\n"),
            "study.yaml:6: stop: needs sampling: random: the intervals that it goes by are of "
            "independent trials, and those of sobol scatter otherwise");
  EXPECT_EQ(error(good, "sampling: latin_hypercube\ntrials: 500\n").substr(0, 37),
            "study.yaml:6: stop: needs sampling: r");
  EXPECT_EQ(error(good, "trials: 100\n"),
            "study.yaml:5: stop: the first look is after 100 trials: expected more than so many in "
            "trials, the most that are run of each case (it is 100)");
  EXPECT_EQ(error("{estimator: stereo, metric: heading_deg.rmse}"),
            "study.yaml:6: stop.0: expected half_width or relative_half_width");
  EXPECT_EQ(error("{metric: heading_deg.rmse, half_width: 1}"),
            "study.yaml:6: stop.0: expected an estimator and its metric");
  EXPECT_EQ(error("{estimator: sterio, metric: heading_deg.rmse, half_width: 1}"),
            "study.yaml:6: stop.0: estimator 'sterio' is not run in example; did you mean "
            "'stereo'?");
  EXPECT_EQ(error("{estimator: stereo, metric: heading_deg.rms, half_width: 1}").substr(0, 57),
            "study.yaml:6: stop.0.metric: 'heading_deg.rms' is no metr");
  EXPECT_EQ(error("{estimator: stereo, metric: heading_deg.rmse, statistic: p95, half_width: 1}")
                .substr(0, 63),
            "study.yaml:6: stop.0.statistic: 'p95' is not one of: mean, medi");
  EXPECT_EQ(error("{estimator: stereo, metric: heading_deg.rmse, statistic: success_rate, "
                  "half_width: 0.1}"),
            "study.yaml:6: stop.0: success_rate needs success_at_most or success_at_least");
}

}  // namespace
}  // namespace polnav::testbed
