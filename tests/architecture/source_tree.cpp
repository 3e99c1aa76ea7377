#include "tests/architecture/source_tree.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace polnav::architecture {
namespace {

namespace fs = std::filesystem;

bool HasEnding(const fs::path& path, const std::vector<std::string>& endings) {
  return std::find(endings.begin(), endings.end(), path.extension().string()) != endings.end();
}

std::string ReadAll(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

std::vector<SourceFile> ReadTree(const fs::path& root, const std::vector<std::string>& places,
                                 const std::vector<std::string>& endings) {
  std::vector<SourceFile> files;
  const auto add = [&](const fs::path& path) {
    files.push_back({path.lexically_relative(root).generic_string(), ReadAll(path)});
  };
  for (const std::string& place : places) {
    if (fs::is_regular_file(root / place)) add(root / place);
    if (!fs::is_directory(root / place)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / place)) {
      if (entry.is_regular_file() && HasEnding(entry.path(), endings)) add(entry.path());
    }
  }
  std::sort(files.begin(), files.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

std::vector<SourceFile> ReadCpp() {
  return ReadTree(Root(), {"sky", "nav", "sim", "tools", "tests"}, {".h", ".cpp"});
}

fs::path Root() { return POLNAV_SOURCE_DIR; }

}  // namespace polnav::architecture
