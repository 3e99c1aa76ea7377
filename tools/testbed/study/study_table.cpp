#include "tools/testbed/study/study_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "tools/testbed/study/schema.h"

namespace polnav::testbed {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> Strings(SQLite::Database& db, const std::string& sql, int column = 0) {
  std::vector<std::string> strings;
  SQLite::Statement query(db, sql);
  while (query.executeStep()) strings.push_back(query.getColumn(column).getString());
  return strings;
}

// Each estimator by a seek: the table is clustered by it.
std::vector<std::string> EstimatorsOf(SQLite::Database& db) {
  std::vector<std::string> names;
  SQLite::Statement first(db, "SELECT min(estimator) FROM scores");
  SQLite::Statement next(db, "SELECT min(estimator) FROM scores WHERE estimator > ?");
  SQLite::Statement* query = &first;
  while (query->executeStep() && !query->getColumn(0).isNull()) {
    names.push_back(query->getColumn(0).getString());
    next.reset();
    next.bind(1, names.back());
    query = &next;
  }
  return names;
}

std::vector<TableCase> CasesOf(SQLite::Database& db) {
  std::vector<TableCase> cases;
  SQLite::Statement query(
      db, "SELECT scenario, scenario_file, variant, label, grid FROM cases ORDER BY case_id");
  while (query.executeStep()) {
    cases.push_back({.scenario = query.getColumn(0).getString(),
                     .scenario_file = query.getColumn(1).getString(),
                     .variant = query.getColumn(2).getString(),
                     .label = query.getColumn(3).getString(),
                     .grid = Json::parse(query.getColumn(4).getString()),
                     .outcomes = {}});
  }
  SQLite::Statement outcomes(
      db, "SELECT case_id, outcome, count(*) FROM trials GROUP BY case_id, outcome");
  while (outcomes.executeStep()) {
    cases.at(static_cast<std::size_t>(outcomes.getColumn(0).getInt64()))
        .outcomes[outcomes.getColumn(1).getString()] =
        static_cast<std::uint64_t>(outcomes.getColumn(2).getInt64());
  }
  return cases;
}

}  // namespace

std::uint64_t TableCase::Finished() const {
  std::uint64_t sum = 0;
  for (const auto& [outcome, count] : outcomes) sum += count;
  return sum;
}

std::uint64_t TableCase::Ok() const {
  const auto found = outcomes.find("ok");
  return found == outcomes.end() ? 0 : found->second;
}

std::vector<double> MetricColumn::Present() const {
  std::vector<double> present;
  present.reserve(values.size());
  for (const double v : values) {
    if (!std::isnan(v)) present.push_back(v);
  }
  return present;
}

StudyTable::StudyTable(SQLite::Database& db) : db_(db), cases_(CasesOf(db)) {
  if (cases_.empty()) throw std::logic_error("a study without cases");
  for (const std::string& column : Strings(db, "PRAGMA table_info(scores)", 1)) {
    if (column != "estimator" && column != "trial" && column != "sha256") {
      metrics_.push_back(column);
    }
  }
  std::sort(metrics_.begin(), metrics_.end());
  estimators_ = EstimatorsOf(db);
  dispersed_ = Strings(db, "SELECT key FROM input_keys WHERE kind = 'dispersed' ORDER BY key");
  SQLite::Statement meta(db, "SELECT key, value FROM meta");
  while (meta.executeStep()) meta_[meta.getColumn(0).getString()] = meta.getColumn(1).getString();
  const Json definition = Json::parse(Meta("definition"), nullptr, false);
  study_ = definition.is_object() ? definition.value("study", Json::object()) : Json::object();
}

std::string StudyTable::Meta(const std::string& key) const {
  const auto found = meta_.find(key);
  return found == meta_.end() ? "" : found->second;
}

std::uint64_t StudyTable::seed() const {
  const std::string seed = Meta("seed");
  return seed.empty() ? 1 : std::stoull(seed);
}

bool StudyTable::HasMetric(const std::string& metric) const {
  return std::binary_search(metrics_.begin(), metrics_.end(), metric);
}

std::vector<CaseColumns> StudyTable::Read(const std::string& estimator,
                                          const std::vector<std::string>& metrics) const {
  std::vector<CaseColumns> read(cases_.size());
  std::string sql = "SELECT trial";
  for (const std::string& metric : metrics) sql += ", " + QuotedName(metric);
  for (std::size_t c = 0; c < cases_.size(); ++c) {
    read[c].columns.resize(metrics.size());
    read[c].trials.reserve(cases_[c].Ok());
    for (MetricColumn& column : read[c].columns) column.values.reserve(cases_[c].Ok());
  }
  SQLite::Statement query(db_, sql + " FROM scores WHERE estimator = ? ORDER BY trial");
  query.bind(1, estimator);
  while (query.executeStep()) {
    const auto trial = static_cast<std::uint64_t>(query.getColumn(0).getInt64());
    CaseColumns& columns = read[CaseOf(trial)];
    columns.trials.push_back(trial);
    for (std::size_t m = 0; m < metrics.size(); ++m) {
      const SQLite::Column value = query.getColumn(static_cast<int>(m) + 1);
      columns.columns[m].values.push_back(value.isNull() ? kNaN : value.getDouble());
    }
  }
  return read;
}

std::vector<InputColumn> StudyTable::ReadInput(const std::string& key, std::uint64_t most) const {
  std::vector<InputColumn> read(cases_.size());
  std::vector<bool> is_text(cases_.size(), false);
  SQLite::Statement query(
      db_, "SELECT trial, " + QuotedName(key) + " FROM inputs WHERE trial < ? ORDER BY trial");
  query.bind(1, static_cast<std::int64_t>(most * cases_.size()));
  while (query.executeStep()) {
    const SQLite::Column value = query.getColumn(1);
    if (value.isNull()) continue;
    const auto trial = static_cast<std::uint64_t>(query.getColumn(0).getInt64());
    InputColumn& column = read[CaseOf(trial)];
    column.trials.push_back(trial);
    column.numbers.push_back(value.getDouble());
    column.text.push_back(value.getString());
    if (value.isText()) is_text[CaseOf(trial)] = true;
  }
  for (std::size_t c = 0; c < read.size(); ++c) {
    if (!is_text[c]) read[c].text.clear();
  }
  return read;
}

ValuePairs PairUp(const std::vector<std::uint64_t>& trials_a, const std::vector<double>& a,
                  const std::vector<std::uint64_t>& trials_b, const std::vector<double>& b) {
  ValuePairs pairs;
  for (std::size_t i = 0, j = 0; i < trials_a.size() && j < trials_b.size();) {
    if (trials_a[i] < trials_b[j]) {
      ++i;
    } else if (trials_b[j] < trials_a[i]) {
      ++j;
    } else {
      if (!std::isnan(a[i]) && !std::isnan(b[j])) {
        pairs.trials.push_back(trials_a[i]);
        pairs.a.push_back(a[i]);
        pairs.b.push_back(b[j]);
      }
      ++i;
      ++j;
    }
  }
  return pairs;
}

}  // namespace polnav::testbed
