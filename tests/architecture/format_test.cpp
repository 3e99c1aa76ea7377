#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/architecture/source_tree.h"

namespace polnav::architecture {
namespace {

struct CommandResult {
  int exit_code = -1;
  std::string output;
};

CommandResult RunCommand(const std::string& command) {
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return {};
  CommandResult result;
  std::array<char, 4096> buffer{};
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) result.output += buffer.data();
  const int status = pclose(pipe);
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

std::string CheckFormat(const std::filesystem::path& folder, const std::string& files) {
  return "cd '" + folder.string() + "' && clang-format --dry-run -Werror --style=file " + files;
}

class FormatTest : public testing::Test {
 protected:
  void SetUp() override {
    if (RunCommand("clang-format --version").exit_code != 0) {
      GTEST_SKIP() << "clang-format is not installed";
    }
  }
};

TEST_F(FormatTest, EverySourceFileIsAsClangFormatLeavesIt) {
  std::string files;
  for (const SourceFile& file : ReadCpp()) files += " '" + file.path + "'";
  const CommandResult result = RunCommand(CheckFormat(Root(), files));
  EXPECT_EQ(result.exit_code, 0) << "run clang-format -i on these:\n" << result.output;
}

TEST_F(FormatTest, FindsAPlantedViolation) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("polnav_format_" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  std::filesystem::copy_file(Root() / ".clang-format", folder / ".clang-format");
  std::ofstream(folder / "planted.cpp") << "int  f( ){return 1 ;}\n";
  const CommandResult result = RunCommand(CheckFormat(folder, "planted.cpp"));
  std::filesystem::remove_all(folder);
  EXPECT_NE(result.exit_code, 0);
  EXPECT_NE(result.output.find("planted.cpp"), std::string::npos) << result.output;
}

}  // namespace
}  // namespace polnav::architecture
