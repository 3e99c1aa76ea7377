// Which values may an option take? What the option structs hand to a visitor besides the field.
#pragma once

#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

namespace polnav::testbed {

// Inclusive; the default admits every finite number.
struct OptionRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();

  // False for NaN.
  [[nodiscard]] bool Contains(double value) const { return value >= min && value <= max; }
};

using OptionChoices = std::initializer_list<const char*>;

// A section whose keys are free: each names a list of values, kept as text that reads back as YAML.
struct NamedLists {
  struct Item {
    std::string name;
    std::vector<std::string> values;
  };
  std::vector<Item> items;  // in the file's order
};

// "[0.1, 500]", "at least 0", "at most 1"; empty when every number is allowed.
[[nodiscard]] std::string RangeText(const OptionRange& range);

}  // namespace polnav::testbed
