#include "tools/testbed/study/study_database.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <sstream>

#include "tools/testbed/build_id.h"
#include "tools/testbed/hash.h"
#include "tools/testbed/input_error.h"
#include "tools/testbed/report.h"
#include "tools/testbed/study/identity.h"

namespace polnav::testbed {
namespace {

constexpr int kBusyTimeout_ms = 10'000;

std::string Complaint(const SQLite::Exception& error) {
  switch (error.getErrorCode()) {
    case SQLITE_FULL:
      return "cannot be written: the disk is full. The trials in it are kept; make room and run "
             "the same command again";
    case SQLITE_READONLY:
      return "is read-only";
    case SQLITE_CANTOPEN:
      return "cannot be opened: is there such a folder, and may it be written to?";
    case SQLITE_IOERR:
      return fmt::format(
          "cannot be read or written ({}). The trials in it are kept; run the same "
          "command again when that is mended",
          error.what());
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "is being written by another program";
    case SQLITE_NOTADB:
      return "is not the result file of a study";
    case SQLITE_CORRUPT:
      return "is damaged: merge what can be read of it into a new file, or start anew";
    default:
      return error.what();
  }
}

std::unique_ptr<SQLite::Database> Open(const std::filesystem::path& path, bool write) {
  const int flags = write ? SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE : SQLite::OPEN_READONLY;
  return std::make_unique<SQLite::Database>(path.string(), flags, kBusyTimeout_ms);
}

int HexDigit(char c) { return c <= '9' ? c - '0' : c - 'a' + 10; }

}  // namespace

std::string JoinedNames(const std::string& some, const std::string& more) {
  std::string joined = some;
  std::stringstream stream(more);
  for (std::string name; std::getline(stream >> std::ws, name, ',');) {
    if ((", " + joined + ", ").find(", " + name + ", ") != std::string::npos) continue;
    joined.append(joined.empty() ? "" : ", ").append(name);
  }
  return joined;
}

std::string ToHex(const std::string& bytes) {
  std::string hex;
  for (const char c : bytes) hex += fmt::format("{:02x}", static_cast<unsigned char>(c));
  return hex;
}

std::string FromHex(const std::string& hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes += static_cast<char>(HexDigit(hex[i]) * 16 + HexDigit(hex[i + 1]));
  }
  return bytes;
}

std::vector<std::string> ColumnsOf(SQLite::Database& db, const std::string& schema,
                                   const std::string& table) {
  std::vector<std::string> names;
  SQLite::Statement query(db, fmt::format("PRAGMA {}.table_info({})", schema, table));
  while (query.executeStep()) names.push_back(query.getColumn(1).getString());
  return names;
}

StudyDatabase::StudyDatabase(std::filesystem::path path, bool write)
    : path_(std::move(path)), write_(write) {
  Guarded([&] { db_ = Open(path_, write); });
}

StudyDatabase::~StudyDatabase() {
  try {
    if (db_) Close();
  } catch (const std::exception&) {
    // Whoever opens the file next finds what was written in the -wal beside it.
  }
}

void StudyDatabase::Guarded(const std::function<void()>& action) const {
  try {
    action();
  } catch (const SQLite::Exception& error) {
    throw InputError(path_.string(), 0, "", Complaint(error));
  }
}

StudyDatabase StudyDatabase::Create(const std::filesystem::path& path, const StudyPlan& plan,
                                    const std::string& study_file, bool mix_builds) {
  StudyDatabase study(path, true);
  study.Guarded([&] {
    const bool is_new = study.IsEmpty();
    if (!is_new) {
      study.CheckSchema();
      study.CheckIdentity(plan);
      if (!mix_builds) study.CheckBuild();
    }
    study.db_->exec("PRAGMA journal_mode=WAL");
    study.db_->exec("PRAGMA synchronous=NORMAL");
    SQLite::Transaction transaction(*study.db_, SQLite::TransactionBehavior::IMMEDIATE);
    if (is_new) study.MakeTables(plan);
    study.DescribeStudy(plan, study_file);
    transaction.commit();
    for (std::string& name : ColumnsOf(*study.db_, "main", "scores")) {
      study.score_columns_.insert(std::move(name));
    }
  });
  return study;
}

StudyDatabase StudyDatabase::OpenToRead(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) throw InputError(path.string(), 0, "", "no such file");
  StudyDatabase study(path, false);
  study.Guarded([&] { study.CheckSchema(); });
  return study;
}

StudyDatabase StudyDatabase::OpenToWrite(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) throw InputError(path.string(), 0, "", "no such file");
  StudyDatabase study(path, true);
  study.Guarded([&] { study.CheckSchema(); });
  return study;
}

bool StudyDatabase::IsEmpty() const {
  return db_->execAndGet("SELECT count(*) FROM sqlite_master").getInt() == 0;
}

void StudyDatabase::CheckSchema() const {
  CheckStudySchema(*db_, path_, ": use that one, or give another file with --out");
}

void StudyDatabase::CheckBuild() const {
  const BuildId build = ThisBuild();
  if (Meta("code") == build.code && Meta("polnav_version") == VersionText()) return;
  throw InputError(
      path_.string(), 0, "",
      fmt::format(
          "its trials were run by other code: commit {} of {}; this is commit {} of {}. Go "
          "on with that one, give another file with --out, or mix the two with --mix-builds "
          "(--trial K tells whether both get the same of trial K)",
          Meta("commit"), Meta("polnav_version"), build.commit, VersionText()));
}

void StudyDatabase::CheckIdentity(const StudyPlan& plan) const {
  if (Meta("identity") == Sha256Of(plan.identity().dump())) return;
  throw InputError(
      path_.string(), 0, "",
      fmt::format("holds another study, '{}': {}. Give another file with --out, or remove it",
                  Meta("name"),
                  FirstDifference(Json::parse(Meta("identity_values")), plan.identity())));
}

void StudyDatabase::MakeTables(const StudyPlan& plan) {
  db_->exec(fmt::format("PRAGMA application_id={}", kStudyApplicationId));
  db_->exec(fmt::format("PRAGMA user_version={}", kStudySchemaVersion));
  db_->exec(kStudySchema);
  for (const auto& [key, by_grid] : plan.InputKeys()) {
    db_->exec("ALTER TABLE inputs ADD COLUMN " + QuotedName(key));
    SQLite::Statement insert(*db_, "INSERT INTO input_keys VALUES (?, ?)");
    insert.bind(1, key);
    insert.bind(2, by_grid ? "grid" : "dispersed");
    insert.exec();
  }
  const Json definition = plan.Definition();
  for (std::size_t i = 0; i < plan.cases().size(); ++i) {
    const StudyCase& c = plan.cases()[i];
    SQLite::Statement insert(*db_, "INSERT INTO cases VALUES (?, ?, ?, ?, ?, ?)");
    insert.bind(1, static_cast<std::int64_t>(i));
    insert.bind(2, c.scenario);
    insert.bind(3, c.scenario_file);
    insert.bind(4, c.variant);
    insert.bind(5, definition["cases"][i]["grid"].dump());
    insert.bind(6, c.label);
    insert.exec();
  }
}

void StudyDatabase::DescribeStudy(const StudyPlan& plan, const std::string& study_file) {
  const StudyOptions& options = plan.options();
  SetMeta("name", options.name);
  SetMeta("description", options.description);
  SetMeta("identity", Sha256Of(plan.identity().dump()));
  SetMeta("identity_values", plan.identity().dump());
  SetMeta("polnav_version", VersionText());
  AddBuild();
  SetMeta("level", options.level);
  SetMeta("seed", fmt::format("{}", options.seed));
  SetMeta("cases", fmt::format("{}", plan.cases().size()));
  SetMeta("trials", fmt::format("{}", options.trials));
  SetMeta("definition", plan.Definition().dump());
  SetMeta("study_file", study_file);
}

void StudyDatabase::AddBuild() {
  const BuildId build = ThisBuild();
  SetMeta("commit", JoinedNames(Meta("commit"), build.commit));
  SetMeta("code", JoinedNames(Meta("code"), build.code));
}

void StudyDatabase::SetMeta(const std::string& key, const std::string& value) {
  SQLite::Statement& insert = Prepared("INSERT OR REPLACE INTO meta VALUES (?, ?)");
  insert.bind(1, key);
  insert.bind(2, value);
  insert.exec();
}

std::string StudyDatabase::Meta(const std::string& key) const {
  std::string value;
  Guarded([&] {
    SQLite::Statement query(*db_, "SELECT value FROM meta WHERE key = ?");
    query.bind(1, key);
    if (query.executeStep()) value = query.getColumn(0).getString();
  });
  return value;
}

SQLite::Statement& StudyDatabase::Prepared(const std::string& sql) {
  std::unique_ptr<SQLite::Statement>& statement = prepared_[sql];
  if (!statement) statement = std::make_unique<SQLite::Statement>(*db_, sql);
  statement->reset();
  statement->clearBindings();
  return *statement;
}

void StudyDatabase::Close() {
  prepared_.clear();
  if (write_ && db_) {
    // A reader that still looks on keeps both files beside this one; nothing is lost by that.
    db_->setBusyTimeout(0);
    (void)db_->tryExec("PRAGMA wal_checkpoint(TRUNCATE)");
    (void)db_->tryExec("PRAGMA journal_mode=DELETE");
  }
  db_.reset();
}

}  // namespace polnav::testbed
