#include "tools/testbed/study/merge.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/testbed/input_error.h"
#include "tools/testbed/study/file_lock.h"
#include "tools/testbed/study/identity.h"
#include "tools/testbed/study/study_database.h"

namespace polnav::testbed {
namespace {

namespace fs = std::filesystem;

std::int64_t Number(SQLite::Database& db, const std::string& query) {
  return db.execAndGet(query).getInt64();
}

void CheckSameBuild(const StudyDatabase& target, const StudyDatabase& input) {
  const bool same = target.Meta("code") == input.Meta("code") &&
                    target.Meta("polnav_version") == input.Meta("polnav_version");
  if (same) return;
  const auto build = [](const StudyDatabase& file) {
    return fmt::format("commit {} of {}", file.Meta("commit"), file.Meta("polnav_version"));
  };
  throw InputError(input.path().string(), 0, "",
                   fmt::format("its trials were run by other code than those of {}: {}; there {}. "
                               "Merge them all the same with --mix-builds",
                               target.path().string(), build(input), build(target)));
}

void CheckSameStudy(const StudyDatabase& target, const StudyDatabase& input) {
  if (target.Meta("identity") == input.Meta("identity")) return;
  throw InputError(input.path().string(), 0, "",
                   fmt::format("is of another study than {}: {}", target.path().string(),
                               FirstDifference(Json::parse(target.Meta("identity_values")),
                                               Json::parse(input.Meta("identity_values")))));
}

// The tables of `input` without its trials: an empty file of the same study.
void CopyFrame(SQLite::Database& db) {
  db.exec(fmt::format("PRAGMA main.application_id={}", kStudyApplicationId));
  db.exec(fmt::format("PRAGMA main.user_version={}", kStudySchemaVersion));
  db.exec(kStudySchema);
  for (const char* table : {"meta", "cases", "input_keys"}) {
    db.exec(fmt::format("INSERT INTO main.{0} SELECT * FROM input.{0}", table));
  }
}

std::string AddMissingColumns(SQLite::Database& db, const std::string& table,
                              const std::string& type) {
  const std::vector<std::string> known = ColumnsOf(db, "main", table);
  std::string list;
  for (const std::string& name : ColumnsOf(db, "input", table)) {
    list.append(list.empty() ? "" : ", ").append(QuotedName(name));
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    db.exec(fmt::format("ALTER TABLE main.{} ADD COLUMN {}{}", table, QuotedName(name), type));
  }
  return list;
}

// Of trials in both files: those that went ok in one only take the other's place. The rest must be
// equal.
void CheckContradictions(SQLite::Database& db, const StudyDatabase& target,
                         const StudyDatabase& input) {
  SQLite::Statement query(
      db,
      "SELECT trial, m.outcome, i.outcome FROM main.trials m JOIN input.trials i USING (trial) "
      "WHERE m.record_sha256 <> i.record_sha256 AND (m.outcome = 'ok') = (i.outcome = 'ok') "
      "ORDER BY trial LIMIT 1");
  if (!query.executeStep()) return;
  throw InputError(
      input.path().string(), 0, "",
      fmt::format("trial {} is '{}' here and '{}' with other results in {}: one of the "
                  "two was made by other code or on a machine that computes otherwise",
                  query.getColumn(0).getInt64(), query.getColumn(2).getString(),
                  query.getColumn(1).getString(), target.path().string()));
}

// Which trials of the input are taken: into a table of their own.
void ChooseTrials(SQLite::Database& db) {
  db.exec("CREATE TEMP TABLE IF NOT EXISTS chosen (trial INTEGER PRIMARY KEY)");
  db.exec("DELETE FROM temp.chosen");
  db.exec(
      "INSERT INTO temp.chosen SELECT trial FROM input.trials i WHERE NOT EXISTS "
      "(SELECT 1 FROM main.trials m WHERE m.trial = i.trial AND "
      "(m.outcome = 'ok' OR i.outcome <> 'ok'))");
}

void TakeTrials(SQLite::Database& db) {
  const std::map<std::string, std::string> columns = {
      {"trials", AddMissingColumns(db, "trials", "")},
      {"inputs", AddMissingColumns(db, "inputs", "")},
      {"scores", AddMissingColumns(db, "scores", " REAL")},
      {"series", AddMissingColumns(db, "series", "")}};
  for (const auto& [table, list] : columns) {
    db.exec(
        fmt::format("DELETE FROM main.{} WHERE trial IN (SELECT trial FROM temp.chosen)", table));
    db.exec(
        fmt::format("INSERT INTO main.{0} ({1}) SELECT {1} FROM input.{0} "
                    "WHERE trial IN (SELECT trial FROM temp.chosen)",
                    table, list));
  }
}

// A shard that asked for more samples than the others: the study is so large.
void TakeTrialCount(SQLite::Database& db) {
  db.exec(
      "UPDATE main.meta SET value = i.value FROM input.meta i WHERE main.meta.key = 'trials' AND "
      "i.key = 'trials' AND CAST(i.value AS INTEGER) > CAST(main.meta.value AS INTEGER)");
}

void TakeBuilds(SQLite::Database& db, const StudyDatabase& target, const StudyDatabase& input) {
  for (const char* key : {"commit", "code"}) {
    SQLite::Statement update(db, "UPDATE main.meta SET value = ? WHERE key = ?");
    update.bind(1, JoinedNames(target.Meta(key), input.Meta(key)));
    update.bind(2, key);
    update.exec();
  }
}

void Attach(SQLite::Database& db, const fs::path& path) {
  SQLite::Statement attach(db, "ATTACH DATABASE ? AS input");
  attach.bind(1, path.string());
  attach.exec();
}

void MergeOne(StudyDatabase& target, const fs::path& path, bool mix_builds, MergeResult& result) {
  const StudyDatabase input = StudyDatabase::OpenToRead(path);
  CheckSameStudy(target, input);
  if (!mix_builds) CheckSameBuild(target, input);
  SQLite::Database& db = target.connection();
  input.Guarded([&] {
    Attach(db, path);
    CheckContradictions(db, target, input);
    ChooseTrials(db);
  });
  target.Guarded([&] {
    SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
    TakeTrials(db);
    TakeTrialCount(db);
    TakeBuilds(db, target, input);
    transaction.commit();
    const auto chosen = static_cast<std::uint64_t>(Number(db, "SELECT count(*) FROM temp.chosen"));
    result.added += chosen;
    result.shared +=
        static_cast<std::uint64_t>(Number(db, "SELECT count(*) FROM input.trials")) - chosen;
    db.exec("DETACH DATABASE input");
  });
}

// The working copy beside the target; it takes the target's place when all went well.
class WorkingCopy {
 public:
  explicit WorkingCopy(const fs::path& target)
      : target_(target), path_(target.string() + ".merging") {
    Remove();
  }
  ~WorkingCopy() { Remove(); }
  WorkingCopy(const WorkingCopy&) = delete;
  WorkingCopy& operator=(const WorkingCopy&) = delete;

  [[nodiscard]] const fs::path& path() const { return path_; }

  void CopyTarget() {
    // Takes in what a crashed study left in the -wal.
    StudyDatabase::OpenToWrite(target_).Close();
    std::error_code error;
    fs::copy_file(target_, path_, error);
    if (error) Fail(error);
  }

  void TakeItsPlace() {
    std::error_code error;
    fs::rename(path_, target_, error);
    if (error) Fail(error);
  }

 private:
  [[noreturn]] void Fail(const std::error_code& error) const {
    throw InputError(target_.string(), 0, "", "cannot be written: " + error.message());
  }
  void Remove() {
    std::error_code ignored;
    for (const char* suffix : {"", "-wal", "-shm", "-journal"}) {
      fs::remove(path_.string() + suffix, ignored);
    }
  }

  fs::path target_;
  fs::path path_;
};

// An empty file of the study that `input` is of.
void MakeFrame(const fs::path& path, const fs::path& input) {
  (void)StudyDatabase::OpenToRead(input);  // is one
  const auto guarded = [&](const std::function<void()>& action) {
    try {
      action();
    } catch (const SQLite::Exception& error) {
      throw InputError(path.string(), 0, "", std::string("cannot be written: ") + error.what());
    }
  };
  guarded([&] {
    SQLite::Database db(path.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    Attach(db, input);
    SQLite::Transaction transaction(db);
    CopyFrame(db);
    transaction.commit();
  });
}

}  // namespace

MergeResult MergeStudies(const fs::path& out, const std::vector<fs::path>& inputs,
                         bool mix_builds) {
  std::error_code ignored;
  for (const fs::path& input : inputs) {
    if (fs::equivalent(input, out, ignored)) {
      throw InputError(input.string(), 0, "", "cannot be merged into itself");
    }
  }
  if (out.has_parent_path()) fs::create_directories(out.parent_path(), ignored);
  const FileLock lock(out);
  WorkingCopy copy(out);
  if (fs::exists(out)) {
    copy.CopyTarget();
  } else {
    MakeFrame(copy.path(), inputs.front());
  }
  MergeResult result;
  {
    StudyDatabase target = StudyDatabase::OpenToWrite(copy.path());
    for (const fs::path& input : inputs) MergeOne(target, input, mix_builds, result);
    result.outcomes = target.Outcomes();
    for (const auto& [outcome, count] : result.outcomes) result.present += count;
    result.expected = std::stoull(target.Meta("cases")) * std::stoull(target.Meta("trials"));
    result.digest = target.Digest();
    target.Close();
  }
  copy.TakeItsPlace();
  return result;
}

}  // namespace polnav::testbed
