// Nothing half-written ever stands under a final name.
#include "tools/testbed/output_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>

#include "tests/testbed/temporary_folder.h"
#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

namespace fs = std::filesystem;

std::string Content(const fs::path& path) {
  std::ifstream stream(path);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::set<std::string> Names(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

TEST(OutputFolder, WritesNothingBeforeCommitAndEverythingThen) {
  const TemporaryFolder temporary;
  OutputFolder folder(temporary.path() / "a" / "b");
  folder.Stage("truth.tum", "1");
  folder.Stage("result.json", "{}");
  EXPECT_TRUE(Names(folder.path()).empty());
  folder.Commit();
  EXPECT_EQ(Names(folder.path()), (std::set<std::string>{"truth.tum", "result.json"}));
  EXPECT_EQ(Content(folder.path() / "result.json"), "{}");
}

TEST(OutputFolder, ReplacesAnOlderRun) {
  const TemporaryFolder temporary;
  for (const std::string content : {"old", "new"}) {
    OutputFolder folder(temporary.path());
    folder.Stage("result.json", content);
    folder.Commit();
  }
  EXPECT_EQ(Content(temporary.path() / "result.json"), "new");
}

TEST(OutputFolder, LeavesTheOlderRunWhenAFileCannotBeWritten) {
  const TemporaryFolder temporary;
  OutputFolder folder(temporary.path());
  folder.Stage("result.json", "old");
  folder.Commit();
  folder.Stage("result.json", "new");
  folder.Stage("no/such/folder.txt", "x");
  EXPECT_THROW(folder.Commit(), InputError);
  EXPECT_EQ(Content(temporary.path() / "result.json"), "old");
  EXPECT_EQ(Names(temporary.path()), std::set<std::string>{"result.json"});
}

// /proc takes no folders, not even from root.
TEST(OutputFolder, RefusesAPlaceThatCannotBeWritten) {
  EXPECT_THROW(OutputFolder("/proc/polnav"), InputError);
  const TemporaryFolder temporary;
  std::ofstream(temporary.path() / "file") << "x";
  EXPECT_THROW(OutputFolder(temporary.path() / "file"), InputError);
}

}  // namespace
}  // namespace polnav::testbed
