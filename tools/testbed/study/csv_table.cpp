#include "tools/testbed/study/csv_table.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "tools/testbed/hash.h"
#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

std::string Trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string> Fields(const std::string& line) {
  std::vector<std::string> fields;
  std::stringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(Trimmed(field));
  if (line.ends_with(',')) fields.emplace_back();
  return fields;
}

}  // namespace

CsvTable ReadCsvTable(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::stringstream text;
  if (!stream || !(text << stream.rdbuf())) {
    throw InputError(path.string(), 0, "", "there is no such table, or it cannot be read");
  }
  CsvTable table;
  table.sha256 = Sha256Of(text.str());
  int number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    line = Trimmed(line);
    if (line.empty() || line.starts_with('#')) continue;
    std::vector<std::string> fields = Fields(line);
    if (table.columns.empty()) {
      table.columns = std::move(fields);
      continue;
    }
    if (fields.size() != table.columns.size()) {
      throw InputError(
          path.string(), number, "",
          fmt::format("{} fields under a header of {}", fields.size(), table.columns.size()));
    }
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (fields[i].empty()) {
        throw InputError(path.string(), number, "",
                         fmt::format("nothing in column '{}'", table.columns[i]));
      }
    }
    table.rows.push_back(std::move(fields));
  }
  if (table.rows.empty()) throw InputError(path.string(), 0, "", "holds no row below a header");
  return table;
}

}  // namespace polnav::testbed
