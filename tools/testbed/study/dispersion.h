// What do the dispersed keys become in one sample?
//
// A Dispersion is an entry of the study's `dispersions`, checked and ready to draw from: it needs
// so many coordinates of the unit cube and fills so many keys.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "tools/testbed/study/csv_table.h"
#include "tools/testbed/study/study_options.h"
#include "tools/testbed/yaml_document.h"

namespace polnav::testbed {

// A value as it goes into the scenario, and as a number where it is one.
struct InputValue {
  std::string key;
  std::string text;
  std::optional<double> number;
};

[[nodiscard]] InputValue TextInput(const std::string& key, const std::string& text);
// The shortest text that reads back as the same number.
[[nodiscard]] InputValue NumberInput(const std::string& key, double number);

class Dispersion {
 public:
  // entry: its place in the study file ("dispersions.2"), for errors. Throws InputError.
  Dispersion(const YamlDocument& document, const std::string& entry,
             const DispersionOptions& options, const std::filesystem::path& folder);

  [[nodiscard]] const std::vector<std::string>& keys() const { return keys_; }
  [[nodiscard]] const std::string& entry() const { return entry_; }
  // Names of the coordinates that At wants.
  [[nodiscard]] std::vector<std::string> Dimensions() const;
  // Draws from a continuum: of no use for whole numbers.
  [[nodiscard]] bool continuous() const;
  // What the values depend on besides the options; empty without a table.
  [[nodiscard]] std::string TableSha256() const;

  // The least and the largest that can ever be drawn for a key; nothing when unbounded or text.
  [[nodiscard]] std::optional<std::pair<double, double>> Bounds(std::size_t key) const;

  [[nodiscard]] std::vector<InputValue> At(std::span<const double> u, std::uint64_t sample) const;

 private:
  struct Correlated {
    Eigen::VectorXd mean;
    Eigen::MatrixXd factor;
  };
  struct LogUniform {
    IntervalOptions interval;
  };
  struct Table {
    CsvTable csv;
    std::vector<std::size_t> columns;  // of each key
    bool in_order = false;
  };

  [[nodiscard]] Correlated LoadCorrelated(const YamlDocument& document,
                                          const CorrelatedOptions& options) const;
  [[nodiscard]] Table LoadTable(const YamlDocument& document, const TableOptions& options,
                                const std::filesystem::path& folder) const;
  void TakeKeys(const YamlDocument& document, const DispersionOptions& options);
  void CheckScalar(const YamlDocument& document, const DispersionOptions& options) const;

  std::string entry_;
  std::vector<std::string> keys_;
  std::variant<NormalOptions, IntervalOptions, LogUniform, DiscreteOptions, Correlated, Table>
      kind_;
};

}  // namespace polnav::testbed
