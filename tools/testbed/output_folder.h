// How do results reach the disk without ever being half there?
//
// Files are collected in memory, written under temporary names and renamed all together at the end.
// The file staged last appears last, and an older file of that name goes first: where it stands,
// all the others are complete and of the same run. A run that fails or is interrupted leaves
// nothing behind.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace polnav::testbed {

class OutputFolder {
 public:
  // Makes the folder; throws InputError when it cannot be made or written to.
  explicit OutputFolder(std::filesystem::path folder);

  void Stage(const std::string& name, std::string content);

  // Throws InputError when the disk does not take it all; then no final name was touched.
  void Commit();

  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

 private:
  [[nodiscard]] std::filesystem::path TemporaryName(const std::string& name) const;

  std::filesystem::path folder_;
  std::vector<std::pair<std::string, std::string>> staged_;
};

}  // namespace polnav::testbed
