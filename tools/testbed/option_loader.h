// Does this section of a YAML file hold valid options, and which?
//
// Driven by an option struct's own Visit. Strict: an unknown key, a wrong type, a value out of
// range or not among the choices throws an InputError with file, line, key path and what would
// have been right. A key that is absent keeps its default; a std::optional section that is absent
// or null is off; any other section that is null keeps its defaults.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/testbed/option_range.h"
#include "tools/testbed/yaml_document.h"

namespace polnav::testbed {

class OptionLoader {
 public:
  OptionLoader(const YamlDocument& document, const YAML::Node& section, std::string path);

  void operator()(const char* key, double& value, OptionRange range = {});
  void operator()(const char* key, std::optional<double>& value, OptionRange range = {});
  void operator()(const char* key, int& value, OptionRange range = {});
  void operator()(const char* key, std::uint64_t& value);
  void operator()(const char* key, Eigen::Vector3d& value, OptionRange range = {});
  void operator()(const char* key, std::vector<Eigen::Vector2d>& value, OptionRange range = {});
  void operator()(const char* key, std::vector<double>& value, OptionRange range = {});
  void operator()(const char* key, std::vector<std::vector<double>>& rows, OptionRange range = {});
  void operator()(const char* key, NamedLists& lists);
  void operator()(const char* key, bool& value);
  void operator()(const char* key, std::string& value);
  void operator()(const char* key, std::string& value, OptionChoices choices);
  // One string stands for a list of one.
  void operator()(const char* key, std::vector<std::string>& value);
  void operator()(const char* key, std::vector<std::string>& value, OptionChoices choices);

  template <typename T>
  void operator()(const char* key, std::optional<T>& section) {
    const YAML::Node node = Take(key);
    if (!node.IsDefined()) return;
    section.reset();
    if (!node.IsNull()) LoadSection(node, JoinKey(path_, key), section.emplace());
  }

  template <typename T>
  void operator()(const char* key, std::vector<T>& list) {
    const YAML::Node node = Take(key);
    if (!node.IsDefined()) return;
    list.clear();
    for (std::size_t i = 0; i < CheckedListSize(node, key); ++i) {
      LoadSection(node[i], JoinKey(JoinKey(path_, key), std::to_string(i)), list.emplace_back());
    }
  }

  template <typename T>
  void operator()(const char* key, T& section) {
    const YAML::Node node = Take(key);
    if (node.IsDefined() && !node.IsNull()) LoadSection(node, JoinKey(path_, key), section);
  }

  // After the last key of the struct was visited.
  void RefuseUnknownKeys() const;

 private:
  template <typename T>
  void LoadSection(const YAML::Node& node, const std::string& path, T& section) {
    OptionLoader loader(document_, node, path);
    section.Visit(loader);
    loader.RefuseUnknownKeys();
  }

  YAML::Node Take(const char* key);
  // Nothing when the key is absent.
  std::optional<std::string> TakeScalar(const char* key, std::string_view expected,
                                        bool quotes_allowed);
  std::optional<double> TakeNumber(const char* key, OptionRange range);
  // A list of just so many numbers.
  void TakeNumbers(const YAML::Node& node, const char* key, OptionRange range, double* value,
                   std::size_t count) const;
  [[nodiscard]] std::size_t CheckedListSize(const YAML::Node& node, const char* key) const;
  void CheckChoice(const std::string& path, const std::string& value, OptionChoices choices) const;
  [[noreturn]] void Fail(const char* key, const std::string& message) const;

  const YamlDocument& document_;
  YAML::Node section_;
  std::string path_;
  std::vector<std::string> known_;
};

template <typename T>
void LoadOptions(const YamlDocument& document, T& options) {
  OptionLoader loader(document, document.root, "");
  options.Visit(loader);
  loader.RefuseUnknownKeys();
}

// Of two words: insertions, deletions, substitutions and swaps of neighbours.
[[nodiscard]] int EditDistance(std::string_view a, std::string_view b);

// The candidate that a misspelt word most likely meant; empty when none is similar.
[[nodiscard]] std::string NearestWord(std::string_view word,
                                      const std::vector<std::string>& candidates);

}  // namespace polnav::testbed
