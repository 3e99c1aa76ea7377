#include "tools/testbed/study/dispersion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "tools/testbed/option_loader.h"
#include "tools/testbed/study/distributions.h"

namespace polnav::testbed {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double DrawNormal(double u, const NormalOptions& normal) {
  if (!normal.min && !normal.max) return NormalQuantile(u, normal.mean, normal.sigma);
  return TruncatedNormalQuantile(u, normal.mean, normal.sigma, normal.min.value_or(-kInfinity),
                                 normal.max.value_or(kInfinity));
}

int KindsGiven(const DispersionOptions& o) {
  return static_cast<int>(o.normal.has_value()) + static_cast<int>(o.uniform.has_value()) +
         static_cast<int>(o.log_uniform.has_value()) + static_cast<int>(o.discrete.has_value()) +
         static_cast<int>(o.correlated.has_value()) + static_cast<int>(o.table.has_value());
}

void CheckInterval(const YamlDocument& document, const std::string& path, double min, double max) {
  if (max > min) return;
  FailAt(document, path, fmt::format("max {} must be above min {}", max, min));
}

Eigen::MatrixXd SquareMatrix(const YamlDocument& document, const std::string& path,
                             const std::vector<std::vector<double>>& rows, std::size_t size) {
  Eigen::MatrixXd matrix(size, size);
  bool square = rows.size() == size;
  for (const std::vector<double>& row : rows) square = square && row.size() == size;
  if (!square) FailAt(document, path, fmt::format("expected {0} rows of {0} numbers", size));
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) matrix(i, j) = rows[i][j];
  }
  return matrix;
}

}  // namespace

InputValue TextInput(const std::string& key, const std::string& text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return {key, text, whole && std::isfinite(number) ? std::optional(number) : std::nullopt};
}

InputValue NumberInput(const std::string& key, double number) {
  return {key, fmt::format("{}", number), number};
}

Dispersion::Dispersion(const YamlDocument& document, const std::string& entry,
                       const DispersionOptions& options, const std::filesystem::path& folder)
    : entry_(entry) {
  TakeKeys(document, options);
  CheckScalar(document, options);
  if (options.normal) kind_ = *options.normal;
  if (options.uniform) kind_ = *options.uniform;
  if (options.log_uniform) kind_ = LogUniform{*options.log_uniform};
  if (options.discrete) kind_ = *options.discrete;
  if (options.correlated) kind_ = LoadCorrelated(document, *options.correlated);
  if (options.table) kind_ = LoadTable(document, *options.table, folder);
}

void Dispersion::TakeKeys(const YamlDocument& document, const DispersionOptions& options) {
  if (KindsGiven(options) != 1) {
    FailAt(document, entry_,
           "expected exactly one of normal, uniform, log_uniform, discrete, correlated, table");
  }
  keys_ = options.keys;
  if (!options.key.empty()) keys_.push_back(options.key);
  const bool several = options.correlated || options.table;
  if (keys_.empty()) {
    FailAt(document, entry_,
           several ? "expected 'keys', a list of scenario keys"
                   : "expected 'key', a scenario key such as sky.max_dop");
  }
  if ((!several && keys_.size() > 1) || (!options.key.empty() && !options.keys.empty())) {
    FailAt(document, entry_ + ".keys",
           "'key' names one; 'keys' is for correlated values and tables");
  }
}

void Dispersion::CheckScalar(const YamlDocument& document, const DispersionOptions& o) const {
  if (o.normal) {
    const double min = o.normal->min.value_or(-kInfinity);
    const double max = o.normal->max.value_or(kInfinity);
    CheckInterval(document, entry_ + ".normal.max", min, max);
    if (min > o.normal->mean + 30.0 * o.normal->sigma ||
        max < o.normal->mean - 30.0 * o.normal->sigma) {
      FailAt(document, entry_ + ".normal", "min and max leave nothing within 30 sigma of the mean");
    }
  }
  if (o.uniform) CheckInterval(document, entry_ + ".uniform.max", o.uniform->min, o.uniform->max);
  if (o.log_uniform) {
    CheckInterval(document, entry_ + ".log_uniform.max", o.log_uniform->min, o.log_uniform->max);
    if (o.log_uniform->min <= 0.0) {
      FailAt(document, entry_ + ".log_uniform.min",
             fmt::format("{} has no logarithm: expected more than 0", o.log_uniform->min));
    }
  }
  if (!o.discrete) return;
  const std::vector<double>& weights = o.discrete->weights;
  if (o.discrete->values.empty()) {
    FailAt(document, entry_ + ".discrete.values", "expected a list of values");
  }
  if (!weights.empty() && weights.size() != o.discrete->values.size()) {
    FailAt(document, entry_ + ".discrete.weights",
           fmt::format("{} weights for {} values", weights.size(), o.discrete->values.size()));
  }
  if (!weights.empty() && *std::max_element(weights.begin(), weights.end()) <= 0.0) {
    FailAt(document, entry_ + ".discrete.weights", "expected at least one above 0");
  }
}

Dispersion::Correlated Dispersion::LoadCorrelated(const YamlDocument& document,
                                                  const CorrelatedOptions& o) const {
  const std::string at = entry_ + ".correlated";
  const std::size_t n = keys_.size();
  if (o.mean.size() != n) {
    FailAt(document, at + ".mean", fmt::format("{} means for {} keys", o.mean.size(), n));
  }
  const bool by_covariance = !o.covariance.empty();
  if (by_covariance == (!o.correlation.empty() || !o.sigma.empty())) {
    FailAt(document, at, "expected either covariance or sigma with correlation");
  }
  Eigen::MatrixXd covariance;
  if (by_covariance) {
    covariance = SquareMatrix(document, at + ".covariance", o.covariance, n);
  } else {
    if (o.sigma.size() != n) {
      FailAt(document, at + ".sigma", fmt::format("{} sigmas for {} keys", o.sigma.size(), n));
    }
    const Eigen::Map<const Eigen::VectorXd> sigma(o.sigma.data(), static_cast<Eigen::Index>(n));
    const Eigen::MatrixXd r = SquareMatrix(document, at + ".correlation", o.correlation, n);
    if (!r.diagonal().isOnes(1e-12)) {
      FailAt(document, at + ".correlation", "expected ones on the diagonal");
    }
    covariance = sigma.asDiagonal() * r * sigma.asDiagonal();
  }
  const auto factor = CholeskyFactor(covariance);
  if (!factor) {
    FailAt(document, at + (by_covariance ? ".covariance" : ".correlation"),
           "expected a symmetric, positive definite matrix");
  }
  return {Eigen::Map<const Eigen::VectorXd>(o.mean.data(), static_cast<Eigen::Index>(n)), *factor};
}

Dispersion::Table Dispersion::LoadTable(const YamlDocument& document, const TableOptions& options,
                                        const std::filesystem::path& folder) const {
  const std::vector<std::string>& names = options.columns.empty() ? keys_ : options.columns;
  if (names.size() != keys_.size()) {
    FailAt(document, entry_ + ".table.columns",
           fmt::format("{} columns for {} keys", names.size(), keys_.size()));
  }
  if (options.file.empty()) FailAt(document, entry_ + ".table.file", "expected a CSV file");
  Table table{ReadCsvTable(folder / options.file), {}, options.order == "in_order"};
  const std::vector<std::string>& columns = table.csv.columns;
  for (const std::string& name : names) {
    const auto found = std::find(columns.begin(), columns.end(), name);
    if (found == columns.end()) {
      const std::string nearest = NearestWord(name, columns);
      FailAt(
          document, entry_ + ".table",
          fmt::format("'{}' is no column of {}: {}{}", name, options.file, fmt::join(columns, ", "),
                      nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
    }
    table.columns.push_back(static_cast<std::size_t>(found - columns.begin()));
  }
  return table;
}

std::vector<std::string> Dispersion::Dimensions() const {
  if (std::holds_alternative<Correlated>(kind_)) return keys_;
  return {keys_.front()};
}

bool Dispersion::continuous() const {
  return !std::holds_alternative<DiscreteOptions>(kind_) && !std::holds_alternative<Table>(kind_);
}

std::string Dispersion::TableSha256() const {
  const auto* table = std::get_if<Table>(&kind_);
  return table != nullptr ? table->csv.sha256 : "";
}

std::optional<std::pair<double, double>> Dispersion::Bounds(std::size_t key) const {
  if (const auto* uniform = std::get_if<IntervalOptions>(&kind_)) {
    return {{uniform->min, uniform->max}};
  }
  if (const auto* log = std::get_if<LogUniform>(&kind_)) {
    return {{log->interval.min, log->interval.max}};
  }
  std::vector<std::string> texts;
  if (const auto* discrete = std::get_if<DiscreteOptions>(&kind_)) texts = discrete->values;
  if (const auto* table = std::get_if<Table>(&kind_)) {
    for (const auto& row : table->csv.rows) texts.push_back(row[table->columns[key]]);
  }
  std::optional<std::pair<double, double>> bounds;
  for (const std::string& text : texts) {
    const std::optional<double> number = TextInput("", text).number;
    if (!number) return std::nullopt;
    if (!bounds) bounds = {*number, *number};
    bounds->first = std::min(bounds->first, *number);
    bounds->second = std::max(bounds->second, *number);
  }
  return bounds;
}

std::vector<InputValue> Dispersion::At(std::span<const double> u, std::uint64_t sample) const {
  if (const auto* correlated = std::get_if<Correlated>(&kind_)) {
    Eigen::VectorXd z(static_cast<Eigen::Index>(keys_.size()));
    for (Eigen::Index i = 0; i < z.size(); ++i) z[i] = NormalQuantile(u[i], 0.0, 1.0);
    const Eigen::VectorXd values = correlated->mean + correlated->factor * z;
    std::vector<InputValue> inputs;
    for (Eigen::Index i = 0; i < z.size(); ++i) {
      inputs.push_back(NumberInput(keys_[static_cast<std::size_t>(i)], values[i]));
    }
    return inputs;
  }
  if (const auto* table = std::get_if<Table>(&kind_)) {
    const std::size_t count = table->csv.rows.size();
    const auto& row =
        table->csv.rows[table->in_order ? sample % count : DiscreteQuantile(u[0], count, {})];
    std::vector<InputValue> inputs;
    for (std::size_t i = 0; i < keys_.size(); ++i) {
      inputs.push_back(TextInput(keys_[i], row[table->columns[i]]));
    }
    return inputs;
  }
  const std::string& key = keys_.front();
  if (const auto* discrete = std::get_if<DiscreteOptions>(&kind_)) {
    const std::size_t i = DiscreteQuantile(u[0], discrete->values.size(), discrete->weights);
    return {TextInput(key, discrete->values[i])};
  }
  if (const auto* normal = std::get_if<NormalOptions>(&kind_)) {
    return {NumberInput(key, DrawNormal(u[0], *normal))};
  }
  if (const auto* log = std::get_if<LogUniform>(&kind_)) {
    return {NumberInput(key, LogUniformQuantile(u[0], log->interval.min, log->interval.max))};
  }
  const auto& uniform = std::get<IntervalOptions>(kind_);
  return {NumberInput(key, UniformQuantile(u[0], uniform.min, uniform.max))};
}

}  // namespace polnav::testbed
