// A study comes out the same however it is run: at once, in parallel, in shards, in pieces.
#include "tools/testbed/study/study_run.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iostream>

#include "tests/testbed/study/study_fixture.h"
#include "tools/testbed/build_id.h"
#include "tools/testbed/input_error.h"
#include "tools/testbed/study/file_lock.h"
#include "tools/testbed/study/merge.h"

namespace polnav::testbed {
namespace {

constexpr const char* kSweep = R"(trials: 10
seed: 5
sampling: sobol
grid:
  sky.thin_cloud_cover: [0, 0.5]
dispersions:
  - key: sky.max_dop
    normal: {mean: 0.7, sigma: 0.05, min: 0.5, max: 0.9}
  - key: sky.model
    discrete: {values: [rayleigh, berry]}
series: {points: 5, samples: 6}
)";

class StudyRun : public ::testing::Test {
 protected:
  StudyRunResult Run(const std::string& name, const StudyRunOptions& options = {},
                     const ClosedLoopFunction& loop = DrawnRun) {
    StudyRunOptions all = options;
    all.out = folder_.File(name);
    all.study_file = "study.yaml";
    return RunStudy(plan_, all, loop, [](const StudyCounts&) {});
  }
  [[nodiscard]] std::string Text(const std::string& name) const {
    return AggregateText(folder_.File(name));
  }
  template <typename Action>
  std::string ErrorOf(const Action& action) {
    try {
      action();
    } catch (const InputError& error) {
      std::string text = error.what();
      const std::string path = folder_.File("");
      for (auto at = text.find(path); at != std::string::npos; at = text.find(path)) {
        text.erase(at, path.size());
      }
      return text;
    }
    return "no error";
  }

  StudyFolder folder_;
  StudyPlan plan_ = folder_.Plan(kSweep);
};

TEST_F(StudyRun, OneJobOrTwoGiveTheSameAggregate) {
  const StudyRunResult one = Run("one.sqlite");
  EXPECT_EQ(one.counts.done, 20U);
  EXPECT_EQ(one.outcomes.at(Outcome::kOk), 20U);
  const StudyRunResult two = Run("two.sqlite", {.jobs = 2});
  EXPECT_EQ(one.digest, two.digest);
  EXPECT_EQ(Text("one.sqlite"), Text("two.sqlite"));
  EXPECT_NE(Text("one.sqlite").find("heading_deg.rmse"), std::string::npos);
  for (const char* suffix : {"-wal", "-shm", ".lock"}) {
    EXPECT_FALSE(std::filesystem::exists(folder_.File("one.sqlite") + suffix)) << suffix;
  }
}

TEST_F(StudyRun, ShardsMergeIntoTheWhole) {
  const StudyRunResult whole = Run("whole.sqlite");
  for (std::uint64_t i = 0; i < 3; ++i) {
    const auto part = Run("s" + std::to_string(i), {.jobs = 2, .shard = {.index = i, .count = 3}});
    EXPECT_EQ(part.counts.total, i < 2 ? 7U : 6U);
  }
  const auto in = [&](const std::string& name) {
    return std::filesystem::path(folder_.File(name));
  };
  const MergeResult first = MergeStudies(in("m.sqlite"), {in("s2"), in("s0")});
  EXPECT_EQ(first.present, 13U);
  EXPECT_EQ(first.expected, 20U);
  const MergeResult second = MergeStudies(in("m.sqlite"), {in("s0"), in("s1"), in("s1")});
  EXPECT_EQ(second.added, 7U);
  EXPECT_EQ(second.shared, 14U);
  EXPECT_EQ(second.digest, whole.digest);
  EXPECT_EQ(Text("m.sqlite"), Text("whole.sqlite"));
  EXPECT_EQ(Run("m.sqlite").counts.resumed, 20U) << "a merged file is complete";
}

TEST_F(StudyRun, GoesOnWhereItWasStopped) {
  const StudyRunResult whole = Run("whole.sqlite");
  // Half of it first, as another process that was stopped would have left it.
  (void)Run("part.sqlite", {.shard = {.index = 1, .count = 2}});
  const StudyRunResult rest = Run("part.sqlite");
  EXPECT_EQ(rest.counts.resumed, 10U);
  EXPECT_EQ(rest.digest, whole.digest);
  EXPECT_EQ(Text("part.sqlite"), Text("whole.sqlite"));
  EXPECT_EQ(Run("part.sqlite").counts.resumed, 20U);
}

TEST_F(StudyRun, FailuresStayUntilTheyAreRetried) {
  const ClosedLoopFunction faulty = [](const Scenario& s, const RunOptions& o,
                                       const std::function<void(double)>& p) {
    if (o.trial == 4) throw std::runtime_error("the wheel came off");
    return DrawnRun(s, o, p);
  };
  const StudyRunResult first = Run("f.sqlite", {}, faulty);
  EXPECT_EQ(first.outcomes.at(Outcome::kFailed), 2U) << "sample 4 of both cases";
  EXPECT_EQ(first.counts.failed, 2U);
  EXPECT_EQ(Run("f.sqlite").outcomes.at(Outcome::kFailed), 2U);
  const StudyRunResult retried = Run("f.sqlite", {.retry_failed = true});
  EXPECT_EQ(retried.counts.resumed, 18U);
  EXPECT_EQ(retried.digest, Run("whole.sqlite").digest);
  EXPECT_EQ(Text("f.sqlite"), Text("whole.sqlite"));
}

TEST_F(StudyRun, ValuesThatTheScenarioRefusesTogetherAreInvalidTrials) {
  const StudyPlan plan = folder_.Plan(
      "trials: 20\ndispersions:\n  - {key: sensors.imu.rate_hz, discrete: {values: [100, 333]}}\n");
  const StudyRunResult result = RunStudy(plan, {.out = folder_.File("i.sqlite"), .study_file = ""},
                                         DrawnRun, [](const StudyCounts&) {});
  EXPECT_EQ(result.outcomes.at(Outcome::kOk) + result.outcomes.at(Outcome::kInvalid), 20U);
  EXPECT_GT(result.outcomes.at(Outcome::kInvalid), 0U);
  const StudyDatabase study = StudyDatabase::OpenToRead(folder_.File("i.sqlite"));
}

TEST_F(StudyRun, ARerunIsByteIdenticalOrSaysWhereItIsNot) {
  (void)Run("r.sqlite");
  const StudyDatabase study = StudyDatabase::OpenToRead(folder_.File("r.sqlite"));
  const StoredTrial stored = study.Find(7).value();
  const TrialRecord same = RerunTrial(plan_, 7, DrawnRun).value();
  EXPECT_EQ(DifferencesOf(same, stored), std::vector<std::string>{});
  const ClosedLoopFunction other = [](const Scenario& s, RunOptions o,
                                      const std::function<void(double)>& p) {
    RunRecord record = DrawnRun(s, o, p);
    record.estimators[0].sha256[5] ^= 1;
    return record;
  };
  EXPECT_EQ(DifferencesOf(RerunTrial(plan_, 7, other).value(), stored),
            std::vector<std::string>{"estimates of stereo"});
}

TEST_F(StudyRun, RefusesAFileThatIsNotItsOwn) {
  (void)Run("a.sqlite");
  const StudyPlan other = folder_.Plan(std::string(kSweep) + "duration_s: 5\n");
  const auto run_other = [&](const std::string& name) {
    return ErrorOf([&] {
      (void)RunStudy(other, {.out = folder_.File(name), .study_file = ""}, DrawnRun,
                     [](const StudyCounts&) {});
    });
  };
  EXPECT_EQ(run_other("a.sqlite"),
            "a.sqlite: holds another study, 'test': its scenario has other values "
            "(cases.0.scenario_sha256). Give another file with --out, or remove it");
  std::ofstream(folder_.File("text.sqlite")) << std::string(5000, 'x');
  EXPECT_EQ(run_other("text.sqlite"), "text.sqlite: is not the result file of a study");
  SQLite::Database(folder_.File("foreign.sqlite"), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)
      .exec("CREATE TABLE t (x)");
  EXPECT_EQ(run_other("foreign.sqlite"), "foreign.sqlite: is not the result file of a study");
  SQLite::Database(folder_.File("a.sqlite"), SQLite::OPEN_READWRITE).exec("PRAGMA user_version=99");
  EXPECT_EQ(ErrorOf([&] { (void)Run("a.sqlite"); }),
            "a.sqlite: was written by a newer polnav (schema 99; this one knows 1): use that one, "
            "or give another file with --out");
  EXPECT_EQ(ErrorOf([&] { (void)MergeStudies(folder_.File("m"), {folder_.File("text.sqlite")}); }),
            "text.sqlite: is not the result file of a study");
}

TEST_F(StudyRun, MergeRefusesMixedStudiesAndContradictions) {
  (void)Run("a.sqlite");
  const StudyPlan other = folder_.Plan(std::string(kSweep) + "duration_s: 5\n");
  (void)RunStudy(other, {.out = folder_.File("b.sqlite"), .study_file = ""}, DrawnRun,
                 [](const StudyCounts&) {});
  const auto merge = [&](const char* into, const char* from) {
    return ErrorOf([&] { (void)MergeStudies(folder_.File(into), {folder_.File(from)}); });
  };
  const std::string before = Text("a.sqlite");
  EXPECT_EQ(merge("a.sqlite", "b.sqlite").substr(0, 38), "b.sqlite: is of another study than a.s");
  EXPECT_EQ(merge("a.sqlite", "a.sqlite"), "a.sqlite: cannot be merged into itself");
  EXPECT_EQ(merge("a.sqlite", "c.sqlite"), "c.sqlite: no such file");
  (void)Run("d.sqlite", {}, [](const Scenario& s, const RunOptions& o, const auto& p) {
    RunRecord record = DrawnRun(s, o, p);
    if (o.trial == 3) record.streams["imu"].sha256[0] ^= 1;
    return record;
  });
  EXPECT_EQ(merge("a.sqlite", "d.sqlite").substr(0, 59),
            "d.sqlite: trial 6 is 'ok' here and 'ok' with other results ");
  EXPECT_EQ(Text("a.sqlite"), before) << "nothing was lost";
}

// As if other code had run the trials of a file.
void PretendOtherCode(const std::string& file) {
  SQLite::Database(file, SQLite::OPEN_READWRITE)
      .exec("UPDATE meta SET value = 'older' WHERE key IN ('code', 'commit')");
}

TEST_F(StudyRun, TrialsOfAnotherBuildAreNotMixedSilently) {
  (void)Run("o.sqlite", {.shard = {.index = 0, .count = 2}});
  PretendOtherCode(folder_.File("o.sqlite"));
  const std::string before = Text("o.sqlite");
  EXPECT_EQ(ErrorOf([&] { (void)Run("o.sqlite"); }).substr(0, 65),
            "o.sqlite: its trials were run by other code: commit older of Poln");
  (void)Run("n.sqlite", {.shard = {.index = 1, .count = 2}});
  EXPECT_EQ(ErrorOf([&] {
              (void)MergeStudies(folder_.File("o.sqlite"), {folder_.File("n.sqlite")});
            }).substr(0, 54),
            "n.sqlite: its trials were run by other code than those");
  EXPECT_EQ(Text("o.sqlite"), before) << "nothing was lost";
  EXPECT_EQ(MergeStudies(folder_.File("o.sqlite"), {folder_.File("n.sqlite")}, true).present, 20U);
  EXPECT_EQ(Run("o.sqlite", {.mix_builds = true}).counts.resumed, 20U);
  EXPECT_EQ(StudyDatabase::OpenToRead(folder_.File("o.sqlite")).Meta("code"),
            "older, " + ThisBuild().code);
}

TEST_F(StudyRun, AReadOnlyFileIsSaidSoAndKept) {
  const StudyRunResult whole = Run("r.sqlite");
  const std::string before = Text("r.sqlite");
  const std::string file = folder_.File("r.sqlite");
  std::filesystem::permissions(file, std::filesystem::perms::owner_read);
  // Root may write all the same; as nobody it may not, in a process of its own.
  std::filesystem::permissions(std::filesystem::path(file).parent_path(),
                               std::filesystem::perms::all);
  if (::getuid() == 0) std::filesystem::permissions(file, std::filesystem::perms(0444));
  const pid_t child = ::fork();
  if (child == 0) {
    if (::getuid() == 0 && ::setuid(65534) != 0) ::_exit(2);
    const std::string error = ErrorOf([&] { (void)Run("r.sqlite"); });
    if (error != "r.sqlite: is read-only") std::cerr << error << std::endl;
    ::_exit(error == "r.sqlite: is read-only" ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(Text("r.sqlite"), before);
}

TEST_F(StudyRun, TwoProcessesOnOneFileDoNotDisturbEachOther) {
  const ClosedLoopFunction slow = [](const Scenario& s, const RunOptions& o, const auto& p) {
    ::usleep(20'000);
    return DrawnRun(s, o, p);
  };
  const pid_t child = ::fork();
  if (child == 0) {
    (void)Run("two.sqlite", {}, slow);
    ::_exit(0);
  }
  // The first has begun when its file is there.
  while (!std::filesystem::exists(folder_.File("two.sqlite"))) ::usleep(1000);
  EXPECT_NE(ErrorOf([&] {
              (void)Run("two.sqlite");
            }).find("another polnav is writing this file (process " + std::to_string(child)),
            std::string::npos);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(Run("two.sqlite").digest, Run("whole.sqlite").digest);
}

TEST_F(StudyRun, OnlyOneProcessWritesAFile) {
  {
    const FileLock held(folder_.File("x.sqlite"));
    EXPECT_NE(ErrorOf([&] { (void)Run("x.sqlite"); }).find("another polnav is writing this file"),
              std::string::npos);
  }
  EXPECT_EQ(ErrorOf([&] { (void)Run("x.sqlite"); }), "no error");
}

TEST_F(StudyRun, AFolderThatCannotBeWrittenToIsSaidSo) {
  EXPECT_NE(ErrorOf([&] {
              (void)RunStudy(plan_, {.out = "/proc/x.sqlite", .study_file = ""}, DrawnRun,
                             [](const StudyCounts&) {});
            }).find("/proc/x.sqlite: cannot be written here"),
            std::string::npos);
}

// As a disk that takes no more: a limit on the size of files, in a process of its own.
TEST_F(StudyRun, WhatWasWrittenBeforeTheDiskFilledUpIsKept) {
  const StudyRunResult whole = Run("whole.sqlite");
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{160'000, 160'000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const std::string error = ErrorOf([&] {
      // Slow enough that each trial is a transaction of its own.
      (void)Run("full.sqlite", {}, [](const Scenario& s, const RunOptions& o, const auto& p) {
        ::usleep(110'000);
        return DrawnRun(s, o, p);
      });
    });
    ::_exit(error.find("The trials in it are kept") != std::string::npos ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  const StudyRunResult resumed = Run("full.sqlite");
  EXPECT_GT(resumed.counts.resumed, 0U);
  EXPECT_LT(resumed.counts.resumed, 20U);
  EXPECT_EQ(resumed.digest, whole.digest);
}

}  // namespace
}  // namespace polnav::testbed
