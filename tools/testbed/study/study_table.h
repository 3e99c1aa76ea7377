// What does the result file of a study say, in the order of its trials?
//
// Reads docs/study_database.md's tables a few columns at a time, so that a million trials with a
// hundred metrics need no more memory than one batch. SQLite's errors pass through.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "tools/testbed/option_tree.h"

namespace polnav::testbed {

struct TableCase {
  std::string scenario;
  std::string scenario_file;
  std::string variant;
  std::string label;
  Json grid;
  Json paper;  // metric -> [{label, value}]; an object
  std::map<std::string, std::uint64_t> outcomes;

  [[nodiscard]] std::uint64_t Finished() const;
  [[nodiscard]] std::uint64_t Ok() const;
};

// One metric of one estimator in one case; values NaN where a trial did not yield it.
struct MetricColumn {
  std::vector<double> values;

  // What is there, in order of trials.
  [[nodiscard]] std::vector<double> Present() const;
};

// Of one case: trials in increasing order, columns in the order asked for.
struct CaseColumns {
  std::vector<std::uint64_t> trials;
  std::vector<MetricColumn> columns;
};

// An input of one case; text where some value is none.
struct InputColumn {
  std::vector<std::uint64_t> trials;
  std::vector<double> numbers;
  std::vector<std::string> text;  // of every value when some is no number, else empty
};

class StudyTable {
 public:
  explicit StudyTable(SQLite::Database& db);

  [[nodiscard]] const std::vector<TableCase>& cases() const { return cases_; }
  [[nodiscard]] const std::vector<std::string>& metrics() const { return metrics_; }  // sorted
  [[nodiscard]] const std::vector<std::string>& estimators() const { return estimators_; }
  [[nodiscard]] const std::vector<std::string>& dispersed() const { return dispersed_; }
  [[nodiscard]] std::string Meta(const std::string& key) const;
  [[nodiscard]] std::uint64_t seed() const;
  [[nodiscard]] const Json& study() const { return study_; }  // the study file with its defaults
  [[nodiscard]] bool HasMetric(const std::string& metric) const;

  // One entry a case; of the first `most` samples of it.
  [[nodiscard]] std::vector<CaseColumns> Read(
      const std::string& estimator, const std::vector<std::string>& metrics,
      std::uint64_t most = std::numeric_limits<std::uint64_t>::max()) const;
  // Of the first `most` samples of each case.
  [[nodiscard]] std::vector<InputColumn> ReadInput(const std::string& key,
                                                   std::uint64_t most) const;

  [[nodiscard]] SQLite::Database& connection() const { return db_; }
  [[nodiscard]] std::size_t CaseOf(std::uint64_t trial) const { return trial % cases_.size(); }

 private:
  SQLite::Database& db_;
  std::vector<TableCase> cases_;
  std::vector<std::string> metrics_;
  std::vector<std::string> estimators_;
  std::vector<std::string> dispersed_;
  std::map<std::string, std::string> meta_;
  Json study_;
};

// Values of two columns in trials that have both, in order.
struct ValuePairs {
  std::vector<std::uint64_t> trials;
  std::vector<double> a;
  std::vector<double> b;
};
[[nodiscard]] ValuePairs PairUp(const std::vector<std::uint64_t>& trials_a,
                                const std::vector<double>& a,
                                const std::vector<std::uint64_t>& trials_b,
                                const std::vector<double>& b);

}  // namespace polnav::testbed
