// kill -9 at random moments, again and again: what is left is always a study that goes on, and in
// the end the same one.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "sim/random.h"
#include "tests/testbed/study/study_fixture.h"
#include "tools/testbed/study/study_run.h"

namespace polnav::testbed {
namespace {

constexpr const char* kLong = R"(trials: 400
seed: 5
grid: {sky.thin_cloud_cover: [0, 0.5]}
dispersions: [{key: sky.max_dop, uniform: {min: 0.5, max: 0.9}}]
)";

// 2 ms a trial: 800 of them on two workers take most of a second.
RunRecord SlowRun(const Scenario& scenario, const RunOptions& options,
                  const std::function<void(double)>& progress) {
  ::usleep(2000);
  return DrawnRun(scenario, options, progress);
}

void RunToTheEnd(const StudyPlan& plan, const std::string& file) {
  (void)RunStudy(plan, {.jobs = 2, .out = file, .study_file = ""}, SlowRun,
                 [](const StudyCounts&) {});
}

TEST(StudyKilled, TwentyTimesAtRandomItEndsAsIfItHadNotBeen) {
  const StudyFolder folder;
  const StudyPlan plan = folder.Plan(kLong);
  RunToTheEnd(plan, folder.File("whole.sqlite"));
  int killed = 0;
  const sim::RandomStream moments(20, 0, "kill");
  for (std::uint64_t i = 0; i < 20; ++i) {
    const pid_t child = ::fork();
    if (child == 0) {
      RunToTheEnd(plan, folder.File("killed.sqlite"));
      ::_exit(0);
    }
    // From before the file is there to well into the study.
    ::usleep(static_cast<useconds_t>(150'000 * moments.At(i).Uniform()));
    ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    if (WIFSIGNALED(status)) ++killed;
    if (std::filesystem::exists(folder.File("killed.sqlite"))) {
      // A process that was killed leaves no half trials: each has its scores.
      StudyDatabase study = StudyDatabase::OpenToWrite(folder.File("killed.sqlite"));
      EXPECT_EQ(study.connection()
                    .execAndGet("SELECT count(*) FROM trials t WHERE (SELECT count(*) FROM scores "
                                "s WHERE s.trial = t.trial) <> 3")
                    .getInt(),
                0);
      EXPECT_EQ(study.connection().execAndGet("PRAGMA integrity_check").getString(), "ok");
    }
  }
  EXPECT_EQ(killed, 20) << "none had time to finish";
  RunToTheEnd(plan, folder.File("killed.sqlite"));
  EXPECT_EQ(AggregateText(folder.File("killed.sqlite")),
            AggregateText(folder.File("whole.sqlite")));
}

}  // namespace
}  // namespace polnav::testbed
