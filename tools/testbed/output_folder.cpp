#include "tools/testbed/output_folder.h"

#include <unistd.h>

#include <fstream>
#include <system_error>

#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

namespace fs = std::filesystem;

bool WriteFile(const fs::path& path, const std::string& content) {
  std::ofstream stream(path, std::ios::binary | std::ios::trunc);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  return stream.good();
}

}  // namespace

OutputFolder::OutputFolder(fs::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error || !fs::is_directory(folder_)) {
    throw InputError(folder_.string(), 0, "",
                     "the output folder cannot be made" + (error ? ": " + error.message() : ""));
  }
  const fs::path probe = TemporaryName("probe");
  const bool writable = WriteFile(probe, "x");
  fs::remove(probe, error);
  if (!writable)
    throw InputError(folder_.string(), 0, "", "the output folder cannot be written to");
}

fs::path OutputFolder::TemporaryName(const std::string& name) const {
  return folder_ / ("." + name + "." + std::to_string(::getpid()) + ".tmp");
}

void OutputFolder::Stage(const std::string& name, std::string content) {
  staged_.emplace_back(name, std::move(content));
}

void OutputFolder::Commit() {
  std::error_code error;
  for (const auto& [name, content] : staged_) {
    if (WriteFile(TemporaryName(name), content)) continue;
    for (const auto& entry : staged_) fs::remove(TemporaryName(entry.first), error);
    throw InputError((folder_ / name).string(), 0, "", "cannot be written; is the disk full?");
  }
  if (!staged_.empty()) fs::remove(folder_ / staged_.back().first, error);
  for (const auto& [name, content] : staged_) {
    fs::rename(TemporaryName(name), folder_ / name, error);
    if (error) {
      for (const auto& entry : staged_) fs::remove(TemporaryName(entry.first), error);
      throw InputError((folder_ / name).string(), 0, "", "cannot be replaced");
    }
  }
  staged_.clear();
}

}  // namespace polnav::testbed
