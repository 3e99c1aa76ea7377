#include "tools/testbed/option_loader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace polnav::testbed {
namespace {

std::string Describe(const YAML::Node& node) {
  if (node.IsMap()) return "a section";
  if (node.IsSequence()) return "a list";
  if (node.IsNull()) return "nothing";
  return fmt::format("'{}'", node.Scalar());
}

// On one line; reads back as the same value.
std::string FlowText(const YAML::Node& node) {
  if (node.IsNull()) return "null";
  if (node.IsScalar() && node.Tag() != "!") return node.Scalar();
  YAML::Emitter out;
  out.SetSeqFormat(YAML::Flow);
  out.SetMapFormat(YAML::Flow);
  if (node.IsScalar()) out << YAML::DoubleQuoted;
  out << node;
  return out.c_str();
}

// The whole text as a number, whatever the locale; YAML's octal and hexadecimal are refused.
template <typename Number>
std::optional<Number> ParseNumber(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}

}  // namespace

std::string RangeText(const OptionRange& range) {
  const bool below = std::isfinite(range.min);
  const bool above = std::isfinite(range.max);
  if (below && above) return fmt::format("[{}, {}]", range.min, range.max);
  if (below) return fmt::format("at least {}", range.min);
  if (above) return fmt::format("at most {}", range.max);
  return "";
}

int EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::vector<int>> d(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = static_cast<int>(i);
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int substitution = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, substitution});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

std::string NearestWord(std::string_view word, const std::vector<std::string>& candidates) {
  std::string nearest;
  int least = 0;
  for (const std::string& candidate : candidates) {
    // A forgotten unit suffix or prefix is a likely mistake, however many letters it has.
    const bool contained = word.size() >= 3 && candidate.find(word) != std::string::npos;
    const int distance = contained ? 1 : EditDistance(word, candidate);
    if (nearest.empty() || distance < least) {
      nearest = candidate;
      least = distance;
    }
  }
  const auto longest = static_cast<int>(std::max(word.size(), nearest.size()));
  return 2 * least <= longest ? nearest : "";
}

OptionLoader::OptionLoader(const YamlDocument& document, const YAML::Node& section,
                           std::string path)
    : document_(document), section_(section), path_(std::move(path)) {
  if (!section.IsMap()) {
    FailAt(document_, path_, "expected a section (key: value), got " + Describe(section));
  }
}

void OptionLoader::RefuseUnknownKeys() const {
  for (const auto& entry : section_) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "?";
    if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
    const std::string nearest = NearestWord(key, known_);
    FailAt(document_, JoinKey(path_, key),
           nearest.empty() ? fmt::format("unknown key; valid here: {}", fmt::join(known_, ", "))
                           : fmt::format("unknown key; did you mean '{}'?", nearest));
  }
}

YAML::Node OptionLoader::Take(const char* key) {
  known_.emplace_back(key);
  const YAML::Node& section = section_;  // the const lookup does not create the key
  return section[key];
}

void OptionLoader::Fail(const char* key, const std::string& message) const {
  FailAt(document_, JoinKey(path_, key), message);
}

std::optional<std::string> OptionLoader::TakeScalar(const char* key, std::string_view expected,
                                                    bool quotes_allowed) {
  const YAML::Node node = Take(key);
  if (!node.IsDefined()) return std::nullopt;
  const bool quoted = node.IsScalar() && node.Tag() == "!";
  if (!node.IsScalar() || (quoted && !quotes_allowed)) {
    Fail(key, fmt::format("expected {}, got {}{}", expected, Describe(node),
                          quoted ? " in quotes" : ""));
  }
  return node.Scalar();
}

std::optional<double> OptionLoader::TakeNumber(const char* key, OptionRange range) {
  const std::optional<std::string> text = TakeScalar(key, "a number", false);
  if (!text) return std::nullopt;
  const std::optional<double> number = ParseNumber<double>(*text);
  if (!number || !std::isfinite(*number)) {
    Fail(key, fmt::format("expected a number, got '{}'", *text));
  }
  if (!range.Contains(*number)) {
    Fail(key, fmt::format("{} is out of range, {}", *text, RangeText(range)));
  }
  return number;
}

void OptionLoader::operator()(const char* key, double& value, OptionRange range) {
  if (const std::optional<double> number = TakeNumber(key, range)) value = *number;
}

void OptionLoader::operator()(const char* key, std::optional<double>& value, OptionRange range) {
  const YAML::Node& section = section_;
  const YAML::Node node = section[key];
  if (node.IsDefined() && node.IsNull()) {
    known_.emplace_back(key);
    value.reset();
  } else if (const std::optional<double> number = TakeNumber(key, range)) {
    value = *number;
  }
}

void OptionLoader::operator()(const char* key, int& value, OptionRange range) {
  const std::optional<std::string> text = TakeScalar(key, "a whole number", false);
  if (!text) return;
  const std::optional<int> number = ParseNumber<int>(*text);
  if (!number) Fail(key, fmt::format("expected a whole number, got '{}'", *text));
  if (!range.Contains(*number)) {
    Fail(key, fmt::format("{} is out of range, {}", *text, RangeText(range)));
  }
  value = *number;
}

void OptionLoader::operator()(const char* key, std::uint64_t& value) {
  const std::optional<std::string> text = TakeScalar(key, "a whole number", false);
  if (!text) return;
  const std::optional<std::uint64_t> number = ParseNumber<std::uint64_t>(*text);
  if (!number)
    Fail(key, fmt::format("expected a whole number from 0 to 2^64 - 1, got '{}'", *text));
  value = *number;
}

void OptionLoader::TakeNumbers(const YAML::Node& node, const char* key, OptionRange range,
                               double* value, std::size_t count) const {
  if (!node.IsSequence() || node.size() != count) {
    Fail(key, fmt::format("expected a list of {} numbers, got ", count) +
                  (node.IsSequence() ? fmt::format("{} items", node.size()) : Describe(node)));
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<double> number =
        node[i].IsScalar() ? ParseNumber<double>(node[i].Scalar()) : std::nullopt;
    if (!number || !std::isfinite(*number)) {
      Fail(key,
           fmt::format("expected a list of {} numbers, got {} in it", count, Describe(node[i])));
    }
    if (!range.Contains(*number)) {
      Fail(key, fmt::format("{} is out of range, {}", node[i].Scalar(), RangeText(range)));
    }
    value[i] = *number;
  }
}

void OptionLoader::operator()(const char* key, Eigen::Vector3d& value, OptionRange range) {
  const YAML::Node node = Take(key);
  if (node.IsDefined()) TakeNumbers(node, key, range, value.data(), 3);
}

void OptionLoader::operator()(const char* key, std::vector<Eigen::Vector2d>& value,
                              OptionRange range) {
  const YAML::Node node = Take(key);
  if (!node.IsDefined()) return;
  value.clear();
  for (std::size_t i = 0; i < CheckedListSize(node, key); ++i) {
    TakeNumbers(node[i], key, range, value.emplace_back().data(), 2);
  }
}

void OptionLoader::operator()(const char* key, std::vector<double>& value, OptionRange range) {
  const YAML::Node node = Take(key);
  if (!node.IsDefined()) return;
  value.resize(CheckedListSize(node, key));
  TakeNumbers(node, key, range, value.data(), value.size());
}

void OptionLoader::operator()(const char* key, std::vector<std::vector<double>>& rows,
                              OptionRange range) {
  const YAML::Node node = Take(key);
  if (!node.IsDefined()) return;
  rows.resize(CheckedListSize(node, key));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].resize(CheckedListSize(node[i], key));
    TakeNumbers(node[i], key, range, rows[i].data(), rows[i].size());
  }
}

void OptionLoader::operator()(const char* key, NamedLists& lists) {
  const YAML::Node node = Take(key);
  if (!node.IsDefined() || node.IsNull()) return;
  if (!node.IsMap()) Fail(key, "expected a section of lists, got " + Describe(node));
  lists.items.clear();
  for (const auto& entry : node) {
    NamedLists::Item& item = lists.items.emplace_back();
    item.name = entry.first.IsScalar() ? entry.first.Scalar() : "?";
    if (!entry.second.IsSequence() || entry.second.size() == 0) {
      FailAt(document_, JoinKey(JoinKey(path_, key), item.name),
             "expected a list of values, got " + Describe(entry.second));
    }
    for (const auto& value : entry.second) item.values.push_back(FlowText(value));
  }
}

void OptionLoader::operator()(const char* key, bool& value) {
  const std::optional<std::string> text = TakeScalar(key, "true or false", false);
  if (!text) return;
  if (*text != "true" && *text != "false") {
    Fail(key, fmt::format("expected true or false, got '{}'", *text));
  }
  value = *text == "true";
}

void OptionLoader::operator()(const char* key, std::string& value) {
  if (std::optional<std::string> text = TakeScalar(key, "text", true)) value = *std::move(text);
}

void OptionLoader::operator()(const char* key, std::string& value, OptionChoices choices) {
  const std::optional<std::string> text = TakeScalar(key, "text", true);
  if (!text) return;
  CheckChoice(JoinKey(path_, key), *text, choices);
  value = *text;
}

void OptionLoader::operator()(const char* key, std::vector<std::string>& value) {
  const YAML::Node node = Take(key);
  if (!node.IsDefined()) return;
  value.clear();
  if (node.IsScalar()) {
    value.push_back(node.Scalar());
    return;
  }
  for (std::size_t i = 0; i < CheckedListSize(node, key); ++i) {
    if (!node[i].IsScalar()) Fail(key, "expected a list of text, got " + Describe(node[i]));
    value.push_back(node[i].Scalar());
  }
}

void OptionLoader::operator()(const char* key, std::vector<std::string>& value,
                              OptionChoices choices) {
  std::vector<std::string> items = value;
  (*this)(key, items);
  for (const std::string& item : items) CheckChoice(JoinKey(path_, key), item, choices);
  value = std::move(items);
}

std::size_t OptionLoader::CheckedListSize(const YAML::Node& node, const char* key) const {
  if (node.IsNull()) return 0;
  if (!node.IsSequence()) Fail(key, "expected a list, got " + Describe(node));
  return node.size();
}

void OptionLoader::CheckChoice(const std::string& path, const std::string& value,
                               OptionChoices choices) const {
  const std::vector<std::string> names(choices.begin(), choices.end());
  if (std::find(names.begin(), names.end(), value) != names.end()) return;
  const std::string nearest = NearestWord(value, names);
  FailAt(document_, path,
         fmt::format("'{}' is not one of: {}{}", value, fmt::join(names, ", "),
                     nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
}

}  // namespace polnav::testbed
