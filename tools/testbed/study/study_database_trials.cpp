// The trials in the result file: reading and writing them.
#include <fmt/format.h>

#include <bit>

#include "tools/testbed/hash.h"
#include "tools/testbed/study/study_database.h"

namespace polnav::testbed {
namespace {

static_assert(std::endian::native == std::endian::little,
              "series are stored as they lie in memory");

std::string BlobAt(const SQLite::Column& column) {
  if (column.isNull()) return "";
  return {static_cast<const char*>(column.getBlob()), static_cast<std::size_t>(column.getBytes())};
}

// Copied by SQLite; null when empty.
void BindBlob(SQLite::Statement& statement, int index, const std::string& bytes) {
  if (!bytes.empty()) statement.bind(index, bytes.data(), static_cast<int>(bytes.size()));
}

void BindSeries(SQLite::Statement& statement, int index, const std::vector<float>& values) {
  if (values.empty()) return;
  statement.bind(index, values.data(), static_cast<int>(values.size() * sizeof(float)));
}

void BindInput(SQLite::Statement& statement, int index, const InputValue& value) {
  if (value.number) {
    statement.bind(index, *value.number);
  } else {
    statement.bind(index, value.text);
  }
}

}  // namespace

std::vector<bool> StudyDatabase::Finished(std::uint64_t count, bool retry_failed) const {
  std::vector<bool> finished(count, false);
  Guarded([&] {
    SQLite::Statement query(*db_, retry_failed ? "SELECT trial FROM trials WHERE outcome = 'ok'"
                                               : "SELECT trial FROM trials");
    while (query.executeStep()) {
      const auto trial = static_cast<std::uint64_t>(query.getColumn(0).getInt64());
      if (trial < count) finished[trial] = true;
    }
  });
  return finished;
}

std::map<Outcome, std::uint64_t> StudyDatabase::Outcomes() const {
  std::map<Outcome, std::uint64_t> counts;
  Guarded([&] {
    SQLite::Statement query(*db_, "SELECT outcome, count(*) FROM trials GROUP BY outcome");
    while (query.executeStep()) {
      const auto outcome = ParseOutcome(query.getColumn(0).getString());
      if (outcome) counts[*outcome] = static_cast<std::uint64_t>(query.getColumn(1).getInt64());
    }
  });
  return counts;
}

std::optional<StoredTrial> StudyDatabase::Find(std::uint64_t trial) const {
  std::optional<StoredTrial> stored;
  Guarded([&] {
    SQLite::Statement query(
        *db_, "SELECT outcome, record_sha256, streams_sha256 FROM trials WHERE trial = ?");
    query.bind(1, static_cast<std::int64_t>(trial));
    if (!query.executeStep()) return;
    stored = StoredTrial{.outcome = ParseOutcome(query.getColumn(0).getString()).value(),
                         .record_sha256 = ToHex(BlobAt(query.getColumn(1))),
                         .streams_sha256 = ToHex(BlobAt(query.getColumn(2))),
                         .estimates_sha256 = {}};
    SQLite::Statement scores(*db_, "SELECT estimator, sha256 FROM scores WHERE trial = ?");
    scores.bind(1, static_cast<std::int64_t>(trial));
    while (scores.executeStep()) {
      stored->estimates_sha256[scores.getColumn(0).getString()] =
          ToHex(BlobAt(scores.getColumn(1)));
    }
  });
  return stored;
}

void StudyDatabase::Write(const std::vector<TrialRecord>& records) {
  if (records.empty()) return;
  Guarded([&] {
    SQLite::Transaction transaction(*db_, SQLite::TransactionBehavior::IMMEDIATE);
    for (const TrialRecord& record : records) Insert(record);
    transaction.commit();
  });
}

void StudyDatabase::Insert(const TrialRecord& record) {
  const auto trial = static_cast<std::int64_t>(record.trial);
  SQLite::Statement& known = Prepared("SELECT 1 FROM trials WHERE trial = ?");
  known.bind(1, trial);
  if (known.executeStep()) {
    for (const char* table : {"trials", "inputs", "scores", "series"}) {
      SQLite::Statement& remove = Prepared(fmt::format("DELETE FROM {} WHERE trial = ?", table));
      remove.bind(1, trial);
      remove.exec();
    }
  }
  known.reset();
  SQLite::Statement& insert = Prepared("INSERT INTO trials VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)");
  insert.bind(1, trial);
  insert.bind(2, static_cast<std::int64_t>(record.case_id));
  insert.bind(3, static_cast<std::int64_t>(record.sample));
  insert.bind(4, std::string(NameOf(record.outcome)));
  insert.bind(5, record.detail);
  BindBlob(insert, 6, FromHex(RecordSha256(record)));
  BindBlob(insert, 7, FromHex(record.streams_sha256));
  insert.bind(8, record.wall_s);
  if (record.peak_rss_mb > 0.0) insert.bind(9, record.peak_rss_mb);
  insert.exec();

  std::string columns = "trial";
  std::string places = "?";
  for (const InputValue& value : record.inputs) {
    columns += ", " + QuotedName(value.key);
    places += ", ?";
  }
  SQLite::Statement& inputs =
      Prepared("INSERT INTO inputs (" + columns + ") VALUES (" + places + ")");
  inputs.bind(1, trial);
  for (std::size_t i = 0; i < record.inputs.size(); ++i) {
    BindInput(inputs, static_cast<int>(i) + 2, record.inputs[i]);
  }
  inputs.exec();
  for (const TrialScore& score : record.scores) InsertScore(record.trial, score);
}

void StudyDatabase::InsertScore(std::uint64_t trial, const TrialScore& score) {
  std::string columns = "estimator, trial, sha256";
  std::string places = "?, ?, ?";
  for (const auto& [path, value] : score.metrics) {
    if (score_columns_.insert(path).second) {
      db_->exec("ALTER TABLE scores ADD COLUMN " + QuotedName(path) + " REAL");
    }
    columns.append(", ").append(QuotedName(path));
    places.append(", ?");
  }
  SQLite::Statement& insert =
      Prepared("INSERT INTO scores (" + columns + ") VALUES (" + places + ")");
  insert.bind(1, score.estimator);
  insert.bind(2, static_cast<std::int64_t>(trial));
  BindBlob(insert, 3, FromHex(score.sha256));
  for (std::size_t i = 0; i < score.metrics.size(); ++i) {
    insert.bind(static_cast<int>(i) + 4, score.metrics[i].second);
  }
  insert.exec();
  if (score.series.heading_deg.empty()) return;
  SQLite::Statement& series = Prepared("INSERT INTO series VALUES (?, ?, ?, ?)");
  series.bind(1, score.estimator);
  series.bind(2, static_cast<std::int64_t>(trial));
  BindSeries(series, 3, score.series.heading_deg);
  BindSeries(series, 4, score.series.position_m);
  series.exec();
}

std::string StudyDatabase::Digest() const {
  Sha256 hash;
  Guarded([&] {
    SQLite::Statement query(*db_, "SELECT trial, record_sha256 FROM trials ORDER BY trial");
    while (query.executeStep()) {
      hash.UpdateValue(query.getColumn(0).getInt64());
      hash.Update(BlobAt(query.getColumn(1)));
    }
  });
  return hash.HexDigest();
}

}  // namespace polnav::testbed
