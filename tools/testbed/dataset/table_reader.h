// What does the next line of this table say?
//
// Comma-separated (EuRoC) or blank-separated (KITTI) text, read line by line, so that a long file
// is never in memory and a broken line far down does not spoil what comes before it. Windows line
// ends, blank lines and lines that start with # are passed over. Every complaint is an InputError
// with file and line.
#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "nav/api/time.h"

namespace polnav::testbed {

enum class TableKind {
  kStampedCsv,    // comma-separated; the first field is a stamp [ns]
  kSecondsWords,  // blank-separated; the first field is a time [s]
  kWords,         // blank-separated, without a stamp
};

struct TableRow {
  nav::TimeNs stamp = 0;
  std::vector<std::string> fields;  // after the stamp
};

class TableReader {
 public:
  TableReader(std::filesystem::path file, TableKind kind);

  // Nothing at the end. Stamps increase from row to row.
  [[nodiscard]] std::optional<TableRow> Next();

  // Of the row that came last.
  [[nodiscard]] double Number(const TableRow& row, std::size_t field) const;  // finite
  void ExpectFields(const TableRow& row, std::initializer_list<std::size_t> counts) const;
  [[noreturn]] void Fail(const std::string& message) const;

 private:
  [[nodiscard]] std::vector<std::string> Split(const std::string& line) const;

  std::filesystem::path file_;
  TableKind kind_;
  std::ifstream stream_;
  int line_ = 0;
  std::optional<nav::TimeNs> last_stamp_;
};

// The last stamp that can be read near the end of a file, to know how long a dataset is; nothing
// when there is none. What is wrong with the file is found out when it is read.
[[nodiscard]] std::optional<nav::TimeNs> LastStamp(const std::filesystem::path& file,
                                                   TableKind kind);

}  // namespace polnav::testbed
