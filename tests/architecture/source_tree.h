// What is written in this project's files?
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace polnav::architecture {

// Path relative to the project's folder, with '/'.
struct SourceFile {
  std::string path;
  std::string text;
};

// All files below these folders (or the files themselves) whose names end in one of these, sorted.
[[nodiscard]] std::vector<SourceFile> ReadTree(const std::filesystem::path& root,
                                               const std::vector<std::string>& places,
                                               const std::vector<std::string>& endings);

// Our C++: headers and sources of every library, tool and test.
[[nodiscard]] std::vector<SourceFile> ReadCpp();

// The project's folder.
[[nodiscard]] std::filesystem::path Root();

}  // namespace polnav::architecture
