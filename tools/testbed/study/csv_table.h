// Which values does this CSV file hold? A header line of column names, then rows; for dispersions.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace polnav::testbed {

struct CsvTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  // as many fields as columns, blanks trimmed
  std::string sha256;                          // of the file
};

// Blank lines, lines that start with # and Windows line ends are passed over; no quoting. Throws
// InputError with file and line.
[[nodiscard]] CsvTable ReadCsvTable(const std::filesystem::path& path);

}  // namespace polnav::testbed
