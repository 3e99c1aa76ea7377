#include "tools/testbed/study/schema.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/testbed/input_error.h"

namespace polnav::testbed {

// `scores` and `series` are clustered by estimator: a report reads one estimator at a time, in
// order of trials, and two estimators are paired by walking both.
const char* const kStudySchema = R"sql(
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE cases (
  case_id INTEGER PRIMARY KEY,
  scenario TEXT NOT NULL,
  scenario_file TEXT NOT NULL,
  variant TEXT NOT NULL,
  grid TEXT NOT NULL,
  label TEXT NOT NULL
);
CREATE TABLE input_keys (key TEXT PRIMARY KEY, kind TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE trials (
  trial INTEGER PRIMARY KEY,
  case_id INTEGER NOT NULL REFERENCES cases,
  sample INTEGER NOT NULL,
  outcome TEXT NOT NULL,
  detail TEXT NOT NULL,
  record_sha256 BLOB NOT NULL,
  streams_sha256 BLOB,
  wall_s REAL NOT NULL,
  peak_rss_mb REAL
);
CREATE TABLE inputs (trial INTEGER PRIMARY KEY);
CREATE TABLE scores (
  estimator TEXT NOT NULL,
  trial INTEGER NOT NULL,
  sha256 BLOB,
  PRIMARY KEY (estimator, trial)
) WITHOUT ROWID;
CREATE TABLE series (
  estimator TEXT NOT NULL,
  trial INTEGER NOT NULL,
  heading_deg BLOB,
  position_m BLOB,
  PRIMARY KEY (estimator, trial)
) WITHOUT ROWID;
)sql";

void CheckStudySchema(SQLite::Database& database, const std::filesystem::path& path,
                      const std::string& remedy) {
  if (database.execAndGet("PRAGMA application_id").getInt() != kStudyApplicationId) {
    throw InputError(path.string(), 0, "", "is not the result file of a study");
  }
  const int version = database.execAndGet("PRAGMA user_version").getInt();
  if (version > kStudySchemaVersion) {
    throw InputError(path.string(), 0, "",
                     fmt::format("was written by a newer polnav (schema {}; this one knows {}){}",
                                 version, kStudySchemaVersion, remedy));
  }
}

std::optional<Outcome> ParseOutcome(std::string_view name) {
  const auto* const found = std::find(kOutcomeNames.begin(), kOutcomeNames.end(), name);
  if (found == kOutcomeNames.end()) return std::nullopt;
  return static_cast<Outcome>(found - kOutcomeNames.begin());
}

std::string QuotedName(std::string_view name) {
  std::string quoted = "\"";
  for (const char c : name) quoted.append(c == '"' ? 2 : 1, c);
  return quoted + "\"";
}

}  // namespace polnav::testbed
