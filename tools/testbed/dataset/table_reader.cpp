#include "tools/testbed/dataset/table_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <sstream>

#include "tools/testbed/decimal_time.h"
#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

constexpr std::streamoff kTail_bytes = 65536;
// 126 years about 1970: differences of two stamps still fit.
constexpr nav::TimeNs kFarthestStamp = 4'000'000'000'000'000'000;

std::string Trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

bool IsPassedOver(const std::string& line) {
  const std::string trimmed = Trimmed(line);
  return trimmed.empty() || trimmed.starts_with('#');
}

std::vector<std::string> SplitLine(const std::string& line, TableKind kind) {
  std::istringstream stream(line);
  if (kind != TableKind::kStampedCsv) {
    return {std::istream_iterator<std::string>(stream), std::istream_iterator<std::string>()};
  }
  std::vector<std::string> fields;
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(Trimmed(field));
  if (Trimmed(line).ends_with(',')) fields.emplace_back();
  return fields;
}

std::optional<nav::TimeNs> ParseNanoseconds(const std::string& text) {
  nav::TimeNs stamp = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), stamp);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole ? std::optional(stamp) : std::nullopt;
}

std::optional<nav::TimeNs> ParseStamp(const std::string& text, TableKind kind) {
  const std::optional<nav::TimeNs> stamp =
      kind == TableKind::kSecondsWords ? ParseDecimalSeconds(text) : ParseNanoseconds(text);
  const bool near = stamp && *stamp <= kFarthestStamp && *stamp >= -kFarthestStamp;
  return near ? stamp : std::nullopt;
}

}  // namespace

TableReader::TableReader(std::filesystem::path file, TableKind kind)
    : file_(std::move(file)), kind_(kind) {
  if (!std::filesystem::is_regular_file(file_)) {
    throw InputError(file_.string(), 0, "", "no such file");
  }
  stream_.open(file_, std::ios::binary);
  if (!stream_) throw InputError(file_.string(), 0, "", "cannot be read");
}

void TableReader::Fail(const std::string& message) const {
  throw InputError(file_.string(), line_, "", message);
}

std::optional<TableRow> TableReader::Next() {
  for (std::string line; std::getline(stream_, line);) {
    ++line_;
    if (IsPassedOver(line)) continue;
    TableRow row{.fields = SplitLine(line, kind_)};
    if (kind_ == TableKind::kWords) return row;
    const std::optional<nav::TimeNs> stamp = ParseStamp(row.fields.front(), kind_);
    if (!stamp) {
      Fail(fmt::format("expected a time in {}, got '{}'",
                       kind_ == TableKind::kStampedCsv ? "whole nanoseconds" : "seconds",
                       row.fields.front()));
    }
    if (last_stamp_ && *stamp <= *last_stamp_) {
      Fail(fmt::format("the time does not increase: {} ns after {} ns", *stamp, *last_stamp_));
    }
    last_stamp_ = row.stamp = *stamp;
    row.fields.erase(row.fields.begin());
    return row;
  }
  if (stream_.bad()) Fail("cannot be read on");
  return std::nullopt;
}

double TableReader::Number(const TableRow& row, std::size_t field) const {
  std::string_view text = row.fields.at(field);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size() && !text.empty();
  if (!whole || !std::isfinite(value)) {
    const std::size_t column = field + (kind_ == TableKind::kWords ? 1 : 2);
    Fail(fmt::format("column {}: expected a number, got '{}'", column, row.fields[field]));
  }
  return value;
}

void TableReader::ExpectFields(const TableRow& row,
                               std::initializer_list<std::size_t> counts) const {
  if (std::find(counts.begin(), counts.end(), row.fields.size()) != counts.end()) return;
  const std::size_t stamp = kind_ == TableKind::kWords ? 0 : 1;
  std::vector<std::size_t> expected;
  for (const std::size_t count : counts) expected.push_back(count + stamp);
  Fail(fmt::format("expected {} columns, got {}", fmt::join(expected, " or "),
                   row.fields.size() + stamp));
}

std::optional<nav::TimeNs> LastStamp(const std::filesystem::path& file, TableKind kind) {
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  if (!stream) return std::nullopt;
  const std::streamoff size = stream.tellg();
  stream.seekg(std::max<std::streamoff>(0, size - kTail_bytes));
  std::string line;
  if (size > kTail_bytes) std::getline(stream, line);  // its beginning is cut off
  std::optional<nav::TimeNs> last;
  while (std::getline(stream, line)) {
    if (IsPassedOver(line)) continue;
    const auto stamp = ParseStamp(SplitLine(line, kind).front(), kind);
    if (stamp) last = std::max(last.value_or(*stamp), *stamp);
  }
  return last;
}

}  // namespace polnav::testbed
