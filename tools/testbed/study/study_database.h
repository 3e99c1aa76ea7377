// Where do the trials of a study go, and which are there already?
//
// The result file of docs/study_database.md. A trial is written as a whole or not at all; several
// that finish together share a transaction. WAL with synchronous=NORMAL: what was written survives
// kill -9; a power cut may take the last trials, never the file. All errors are InputErrors that
// say what to do.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/testbed/study/study_plan.h"
#include "tools/testbed/study/trial_record.h"

namespace polnav::testbed {

// What the file says of a finished trial, hashes hexadecimal.
struct StoredTrial {
  Outcome outcome = Outcome::kOk;
  std::string record_sha256;
  std::string streams_sha256;
  std::map<std::string, std::string> estimates_sha256;
};

class StudyDatabase {
 public:
  // Makes the file, or goes on with one of the same study. study_file: as typed. mix_builds: also
  // with one whose trials other code has run.
  [[nodiscard]] static StudyDatabase Create(const std::filesystem::path& path,
                                            const StudyPlan& plan, const std::string& study_file,
                                            bool mix_builds = false);
  [[nodiscard]] static StudyDatabase OpenToRead(const std::filesystem::path& path);
  // An existing study, to merge into.
  [[nodiscard]] static StudyDatabase OpenToWrite(const std::filesystem::path& path);

  // Throws when the file is of another study.
  void CheckIdentity(const StudyPlan& plan) const;
  // Throws when other code has run trials of it.
  void CheckBuild() const;

  // Empty when there is no such fact.
  [[nodiscard]] std::string Meta(const std::string& key) const;

  // Which of the first `count` trials need not be run; those that failed count unless retried.
  [[nodiscard]] std::vector<bool> Finished(std::uint64_t count, bool retry_failed) const;
  [[nodiscard]] std::map<Outcome, std::uint64_t> Outcomes() const;
  [[nodiscard]] std::optional<StoredTrial> Find(std::uint64_t trial) const;

  // In one transaction; takes the place of what was recorded of the same trials.
  void Write(const std::vector<TrialRecord>& records);

  // SHA-256 over the numbers and record hashes of all trials, in order: equal for equal studies,
  // however they were run.
  [[nodiscard]] std::string Digest() const;

  // The file by itself, without -wal and -shm. Also done by the destructor, as far as it goes.
  void Close();

  [[nodiscard]] SQLite::Database& connection() { return *db_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  // Runs an action, and turns what SQLite complains about into an InputError about this file.
  void Guarded(const std::function<void()>& action) const;

  ~StudyDatabase();
  StudyDatabase(StudyDatabase&&) noexcept = default;
  StudyDatabase& operator=(StudyDatabase&&) = delete;

 private:
  StudyDatabase(std::filesystem::path path, bool write);

  [[nodiscard]] bool IsEmpty() const;
  void CheckSchema() const;
  void MakeTables(const StudyPlan& plan);
  void DescribeStudy(const StudyPlan& plan, const std::string& study_file);
  void AddBuild();
  void SetMeta(const std::string& key, const std::string& value);
  void Insert(const TrialRecord& record);
  void InsertScore(std::uint64_t trial, const TrialScore& score);
  SQLite::Statement& Prepared(const std::string& sql);

  std::filesystem::path path_;
  bool write_ = false;
  std::unique_ptr<SQLite::Database> db_;
  std::map<std::string, std::unique_ptr<SQLite::Statement>> prepared_;
  std::set<std::string> score_columns_;
};

// "a, b" and "b, c": "a, b, c". Of commits, of code.
[[nodiscard]] std::string JoinedNames(const std::string& some, const std::string& more);

// Bytes to lower-case hexadecimal digits and back.
[[nodiscard]] std::string ToHex(const std::string& bytes);
[[nodiscard]] std::string FromHex(const std::string& hex);

// Names of a table's columns, in order.
[[nodiscard]] std::vector<std::string> ColumnsOf(SQLite::Database& db, const std::string& schema,
                                                 const std::string& table);

}  // namespace polnav::testbed
