#include "tests/testbed/study/example_study.h"

#include <cmath>
#include <vector>

#include "sim/random.h"
#include "tools/testbed/study/schema.h"

namespace polnav::testbed {
namespace {

void Meta(SQLite::Database& db, const std::string& key, const std::string& value) {
  SQLite::Statement insert(db, "INSERT INTO meta VALUES (?, ?)");
  insert.bind(1, key);
  insert.bind(2, value);
  insert.exec();
}

void MakeTables(SQLite::Database& db, const ExampleStudyOptions& options) {
  db.exec("PRAGMA application_id=" + std::to_string(kStudyApplicationId));
  db.exec("PRAGMA user_version=" + std::to_string(kStudySchemaVersion));
  db.exec(kStudySchema);
  db.exec("INSERT INTO cases VALUES (0, 'linear', 'linear.yaml', '', '{}', 'linear <problem>')");
  db.exec("INSERT INTO input_keys VALUES ('a', 'dispersed'), ('b', 'dispersed')");
  db.exec("ALTER TABLE inputs ADD COLUMN a");
  db.exec("ALTER TABLE inputs ADD COLUMN b");
  for (const char* metric : {"heading_deg.rmse", "nees.position", "sim_duration_s"}) {
    db.exec("ALTER TABLE scores ADD COLUMN " + QuotedName(metric) + " REAL");
  }
  for (int m = 0; m < options.more_metrics; ++m) {
    db.exec("ALTER TABLE scores ADD COLUMN " + QuotedName("noise." + std::to_string(m)) + " REAL");
  }
  Meta(db, "name", "linear");
  Meta(db, "seed", "7");
  Meta(db, "level", "measurement");
  Meta(db, "trials", std::to_string(options.trials));
  Meta(db, "study_file", "linear.yaml");
  const std::string paper =
      R"([{"paper": {"heading_deg.rmse": [{"label": "Paper1999: method", "value": 4.5}],
                      "heading_deg.max": [{"label": "Paper1999: method", "value": 21}]}}])";
  Meta(db, "definition",
       "{\"study\": {\"criteria\": " + options.criteria +
           "}, \"cases\": " + (options.paper ? paper : "[]") + "}");
}

void WriteSeries(SQLite::Database& db, const std::string& estimator, std::int64_t trial,
                 double level) {
  std::vector<float> errors;
  for (int k = 0; k < 41; ++k) {
    errors.push_back(static_cast<float>(level * std::sin(0.2 * k)));
  }
  static_assert(sizeof(float) == 4);
  SQLite::Statement insert(db, "INSERT INTO series VALUES (?, ?, ?, NULL)");
  insert.bind(1, estimator);
  insert.bind(2, trial);
  insert.bind(3, errors.data(), static_cast<int>(errors.size() * sizeof(float)));
  insert.exec();
}

}  // namespace

void FillExampleStudy(SQLite::Database& db, const ExampleStudyOptions& options) {
  MakeTables(db, options);
  SQLite::Transaction transaction(db);
  std::string places = "?, ?, NULL, ?, ?, ?";
  for (int m = 0; m < options.more_metrics; ++m) places += ", ?";
  SQLite::Statement trials(db, "INSERT INTO trials VALUES (?, 0, ?, ?, ?, x'00', NULL, 0, NULL)");
  SQLite::Statement inputs(db, "INSERT INTO inputs VALUES (?, ?, ?)");
  SQLite::Statement scores(db, "INSERT INTO scores VALUES (" + places + ")");
  const sim::RandomStream stream(7, 0, "example");
  for (std::uint64_t i = 0; i < options.trials; ++i) {
    const auto trial = static_cast<std::int64_t>(options.backwards ? options.trials - 1 - i : i);
    sim::RandomStream::Sample sample = stream.At(static_cast<std::uint64_t>(trial));
    const bool ok = trial % 50 != 49;
    trials.bind(1, trial);
    trials.bind(2, trial);
    trials.bind(3, ok ? "ok" : "failed");
    trials.bind(4, ok ? "" : "threw <something>");
    trials.exec();
    trials.reset();
    const double a = sample.Gaussian();
    const double b = sample.Gaussian();
    inputs.bind(1, trial);
    inputs.bind(2, a);
    inputs.bind(3, b);
    inputs.exec();
    inputs.reset();
    if (!ok) continue;
    const double first = 5.0 + 2.0 * a + b + 2.0 * sample.Gaussian();
    const double second = first + 1.0 + 0.5 * sample.Gaussian();
    double chi2 = 0.0;
    for (int k = 0; k < 3; ++k) chi2 += std::pow(sample.Gaussian(), 2);
    for (const char* estimator : {"first", "second"}) {
      const bool is_first = estimator[0] == 'f';
      scores.bind(1, estimator);
      scores.bind(2, trial);
      scores.bind(3, is_first ? first : second);
      scores.bind(4, is_first ? chi2 : 2.0 * chi2);
      scores.bind(5, 20.0);
      for (int m = 0; m < options.more_metrics; ++m) scores.bind(6 + m, sample.Uniform());
      scores.exec();
      scores.reset();
      if (options.series) WriteSeries(db, estimator, trial, is_first ? first : second);
    }
  }
  transaction.commit();
}

}  // namespace polnav::testbed
