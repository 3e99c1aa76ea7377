// The study that stands for all of them, through polnav itself: real drives, real processes.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>

#include "tests/testbed/study/study_fixture.h"
#include "tools/testbed/study/study_database.h"

namespace polnav::testbed {
namespace {

int Polnav(const std::string& arguments) {
  const std::string command = std::string(POLNAV_BINARY) + " " + arguments;
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(StudySmoke, RunsInShardsAndAtOnceToTheSameAggregate) {
  const StudyFolder folder;
  const std::string study = POLNAV_SOURCE_DIR "/scenarios/studies/smoke.yaml --quiet --out ";
  ASSERT_EQ(Polnav("study " + study + folder.File("whole") + " --jobs 2"), 0);
  ASSERT_EQ(Polnav("study " + study + folder.File("a") + " --jobs 1 --shard 1/2"), 0);
  ASSERT_EQ(Polnav("study " + study + folder.File("b") + " --jobs 1 --shard 2/2"), 0);
  ASSERT_EQ(Polnav("merge --quiet " + folder.File("ab") + " " + folder.File("a") + " " +
                   folder.File("b")),
            0);
  EXPECT_EQ(AggregateText(folder.File("ab")), AggregateText(folder.File("whole")));
  EXPECT_EQ(Polnav("study " + study + folder.File("whole") + " --trial 5"), 0);
}

TEST(StudyFiles, AreAllValid) {
  for (const auto& entry :
       std::filesystem::directory_iterator(POLNAV_SOURCE_DIR "/scenarios/studies")) {
    if (entry.path().extension() != ".yaml") continue;
    EXPECT_NO_THROW((void)LoadStudy(entry.path())) << entry.path();
  }
}

}  // namespace
}  // namespace polnav::testbed
