// polnav study and polnav merge: exit codes, what is said, what is left behind.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <sstream>

#include "tests/testbed/study/study_fixture.h"
#include "tools/polnav/command_line.h"
#include "tools/polnav/study_progress.h"

namespace polnav::testbed {
namespace {

class StudyCommand : public ::testing::Test {
 protected:
  int Call(const std::vector<std::string>& arguments, const ClosedLoop& loop = DrawnRun) {
    out_.str("");
    err_.str("");
    return RunCommandLine(arguments, {out_, err_, false}, loop);
  }
  int CallStudy(std::vector<std::string> more, const ClosedLoop& loop = DrawnRun) {
    more.insert(more.begin(), {"study", study_});
    return Call(more, loop);
  }
  [[nodiscard]] bool Printed(const std::string& text) const {
    return out_.str().find(text) != std::string::npos;
  }
  [[nodiscard]] bool Complained(const std::string& text) const {
    return err_.str().find(text) != std::string::npos;
  }

  StudyFolder folder_;
  std::string study_ = folder_.WriteStudy(kTwoDispersions);
  std::string file_ = folder_.File("r.sqlite");
  std::ostringstream out_;
  std::ostringstream err_;
};

TEST_F(StudyCommand, RunsAndSaysWhatCameOut) {
  EXPECT_EQ(CallStudy({"--out", file_, "--jobs", "2"}), kExitHolds) << err_.str();
  EXPECT_TRUE(Printed("4 of 4 trials: 4 ok"));
  EXPECT_TRUE(Printed("aggregate "));
  EXPECT_TRUE(Complained("test: 4 of 4 trials"));
  EXPECT_EQ(CallStudy({"--out", file_, "--trials", "6", "--quiet"}), kExitHolds) << err_.str();
  EXPECT_EQ(out_.str() + err_.str(), "");
  EXPECT_EQ(StudyDatabase::OpenToRead(file_).Outcomes().at(Outcome::kOk), 6U);
}

TEST_F(StudyCommand, TrialsThatDoNotGoOkAreOneUnlessACriterionAllowsThem) {
  const ClosedLoop crash = [](const Scenario& s, const RunOptions& o, const auto& p) {
    if (o.trial == 1) {
      ::signal(SIGSEGV, SIG_DFL);
      ::raise(SIGSEGV);
    }
    return DrawnRun(s, o, p);
  };
  EXPECT_EQ(CallStudy({"--out", file_}, crash), kExitCriterionFailed);
  EXPECT_TRUE(Printed("3 ok, 1 crashed"));
  EXPECT_TRUE(Printed("FAILS  every trial goes ok [example]: expected ok_rate >= 1, got 0.75 "))
      << out_.str();
  EXPECT_EQ(Call({"report", file_, "--quiet"}), kExitCriterionFailed);
  EXPECT_TRUE(Complained("FAILS  every trial goes ok")) << err_.str();
  folder_.WriteStudy(std::string(kTwoDispersions) +
                     "criteria:\n  - {name: most, statistic: ok_rate, at_least: 0.5}\n");
  EXPECT_EQ(CallStudy({"--out", file_}, crash), kExitHolds) << err_.str();
  EXPECT_EQ(CallStudy({"--out", file_, "--retry-failed"}), kExitHolds);
  EXPECT_TRUE(Printed("4 ok"));
}

TEST_F(StudyCommand, OneTrialAgainIsComparedWithItsRecord) {
  EXPECT_EQ(CallStudy({"--out", file_, "--trial", "2"}), kExitHolds) << err_.str();
  EXPECT_TRUE(Printed("not recorded"));
  EXPECT_FALSE(std::filesystem::exists(file_));
  EXPECT_EQ(CallStudy({"--out", file_}), kExitHolds);
  EXPECT_EQ(CallStudy({"--out", file_, "--trial", "2"}), kExitHolds);
  EXPECT_TRUE(Printed("trial 2: example, sample 2: ok"));
  EXPECT_TRUE(Printed("sky.max_dop = "));
  EXPECT_TRUE(Printed("byte-identical"));
  const ClosedLoop other = [](const Scenario& s, RunOptions o, const auto& p) {
    o.seed += 1;
    return DrawnRun(s, o, p);
  };
  EXPECT_EQ(CallStudy({"--out", file_, "--trial", "2"}, other), kExitCriterionFailed);
  EXPECT_TRUE(Complained("trial 2 differs from " + file_ + ": estimates of stereo; estimates of"));
  EXPECT_EQ(CallStudy({"--out", file_, "--trial", "4"}), kExitBadInput);
  EXPECT_EQ(err_.str(), "polnav: --trial 4: the study's 4 trials are numbered from 0\n");
}

TEST_F(StudyCommand, ShardsAreMergedByTheirCommand) {
  const std::string whole = folder_.File("whole");
  const std::string a = folder_.File("a");
  const std::string b = folder_.File("b");
  EXPECT_EQ(CallStudy({"--out", whole}), kExitHolds);
  EXPECT_EQ(CallStudy({"--out", a, "--shard", "1/2"}), kExitHolds);
  EXPECT_TRUE(Printed("2 of 2 trials"));
  EXPECT_EQ(CallStudy({"--out", b, "--shard", "2/2"}), kExitHolds);
  EXPECT_EQ(Call({"merge", file_, a, b}), kExitHolds) << err_.str();
  EXPECT_TRUE(Printed("4 trials added, 0 were there already"));
  EXPECT_TRUE(Printed("4 of 4 trials: 4 ok"));
  EXPECT_EQ(AggregateText(file_), AggregateText(whole));
  EXPECT_EQ(Call({"merge", file_, a}), kExitHolds);
  EXPECT_TRUE(Printed("0 trials added, 2 were there already"));
}

TEST_F(StudyCommand, BadInputIsTwo) {
  EXPECT_EQ(CallStudy({"--out", file_, "--shard", "3/2"}), kExitBadInput);
  EXPECT_EQ(err_.str(), "polnav: --shard 3/2: there is no part 3 of 2: K is at most N\n");
  EXPECT_EQ(CallStudy({"--out", file_, "--trials", "none"}), kExitBadInput);
  EXPECT_TRUE(Complained("--trials none: trials: expected a whole number"));
  EXPECT_EQ(CallStudy({"--out", file_, "--level", "imagine"}), kExitBadInput);
  EXPECT_TRUE(Complained("did you mean 'image'?"));
  EXPECT_EQ(Call({"study", folder_.File("none.yaml")}), kExitBadInput);
  EXPECT_EQ(Call({"merge", file_, folder_.File("none")}), kExitBadInput);
  EXPECT_FALSE(std::filesystem::exists(file_)) << "nothing was begun";
}

TEST_F(StudyCommand, StoppedBySignalItSaysHowToGoOn) {
  const ClosedLoop stop = [](const Scenario& s, const RunOptions& o, const auto& p) {
    if (o.trial == 2) {
      ::kill(::getppid(), SIGTERM);
      while (true) ::pause();
    }
    return DrawnRun(s, o, p);
  };
  EXPECT_EQ(CallStudy({"--out", file_, "--jobs", "1"}, stop), 128 + SIGTERM);
  EXPECT_TRUE(Complained("stopped; 2 of 4 trials are in " + file_)) << err_.str();
  EXPECT_EQ(CallStudy({"--out", file_}), kExitHolds);
  EXPECT_EQ(StudyDatabase::OpenToRead(file_).Outcomes().at(Outcome::kOk), 4U);
}

TEST(StudyProgressText, TellsRateFailuresAndTimeLeft) {
  EXPECT_EQ(StudyProgressText({.total = 100, .done = 0}, 0.0), "0 of 100 trials");
  EXPECT_EQ(StudyProgressText({.total = 100, .done = 40, .resumed = 20, .failed = 3}, 60.0),
            "40 of 100 trials, 3 failed, 1200 an hour, 3 min left");
  EXPECT_EQ(StudyProgressText({.total = 10, .done = 10, .resumed = 10}, 5.0), "10 of 10 trials");
}

TEST(StudyProgress, MovesOnATerminalAndIsSilentWhenQuiet) {
  std::ostringstream out;
  std::ostringstream err;
  const Console terminal{out, err, true};
  StudyProgress bar(terminal, "s", false);
  bar.Show({.total = 30, .done = 10});
  EXPECT_EQ(err.str().substr(0, 44), "\rs [##########....................] 10 of 30");
  err.str("");
  StudyProgress quiet(terminal, "s", true);
  quiet.Show({.total = 2, .done = 1});
  quiet.Finish();
  EXPECT_EQ(err.str(), "");
}

}  // namespace
}  // namespace polnav::testbed
