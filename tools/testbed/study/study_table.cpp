#include "tools/testbed/study/study_table.h"

#include <sqlite3.h>

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
                     .paper = Json::object(),
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

// A query by sqlite3 itself: SQLiteCpp makes an object of each value, and a million trials have a
// hundred million of them.
class NumberQuery {
 public:
  NumberQuery(SQLite::Database& db, const std::string& sql, const std::string& text,
              std::uint64_t number)
      : db_(db.getHandle()) {
    Check(sqlite3_prepare_v2(db_, sql.c_str(), -1, &statement_, nullptr));
    Check(sqlite3_bind_text(statement_, 1, text.c_str(), -1, SQLITE_TRANSIENT));
    Check(sqlite3_bind_int64(statement_, 2, static_cast<std::int64_t>(number)));
  }
  ~NumberQuery() { sqlite3_finalize(statement_); }
  NumberQuery(const NumberQuery&) = delete;
  NumberQuery& operator=(const NumberQuery&) = delete;

  bool Step() {
    const int code = sqlite3_step(statement_);
    if (code == SQLITE_ROW) return true;
    if (code != SQLITE_DONE) throw SQLite::Exception(db_, code);
    return false;
  }
  [[nodiscard]] std::int64_t Integer(int column) const {
    return sqlite3_column_int64(statement_, column);
  }
  // NaN when null.
  [[nodiscard]] double Number(int column) const {
    return sqlite3_column_type(statement_, column) == SQLITE_NULL
               ? kNaN
               : sqlite3_column_double(statement_, column);
  }

 private:
  void Check(int code) const {
    if (code != SQLITE_OK) throw SQLite::Exception(db_, code);
  }

  sqlite3* db_;
  sqlite3_stmt* statement_ = nullptr;
};

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

StudyTable::StudyTable(SQLite::Database& db)
    : db_(db), cases_(CasesOf(db)), study_(Json::object()) {
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
  if (!definition.is_object()) return;
  study_ = definition.value("study", Json::object());
  const Json cases = definition.value("cases", Json::array());
  for (std::size_t c = 0; c < std::min(cases_.size(), cases.size()); ++c) {
    cases_[c].paper = cases[c].value("paper", Json::object());
  }
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
                                          const std::vector<std::string>& metrics,
                                          std::uint64_t most) const {
  std::vector<CaseColumns> read(cases_.size());
  std::string sql = "SELECT trial";
  for (const std::string& metric : metrics) sql += ", " + QuotedName(metric);
  for (std::size_t c = 0; c < cases_.size(); ++c) {
    const std::uint64_t expected = std::min(most, cases_[c].Ok());
    read[c].columns.resize(metrics.size());
    read[c].trials.reserve(expected);
    for (MetricColumn& column : read[c].columns) column.values.reserve(expected);
  }
  constexpr auto kLast = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  const std::uint64_t end = most < kLast / cases_.size() ? most * cases_.size() : kLast;
  NumberQuery query(db_, sql + " FROM scores WHERE estimator = ? AND trial < ? ORDER BY trial",
                    estimator, end);
  while (query.Step()) {
    const auto trial = static_cast<std::uint64_t>(query.Integer(0));
    CaseColumns& columns = read[CaseOf(trial)];
    columns.trials.push_back(trial);
    for (std::size_t m = 0; m < metrics.size(); ++m) {
      columns.columns[m].values.push_back(query.Number(static_cast<int>(m) + 1));
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
