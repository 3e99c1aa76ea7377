// How does the result file of a study look inside?
//
// One SQLite file; docs/study_database.md explains every table and has example queries. The tables
// `inputs` and `scores` have a column for each dispersed key and for each metric, named by its
// dotted path ("heading_deg.rmse"): columns appear when a value of that name first does.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace polnav::testbed {

// PRAGMA application_id: "PLNV". What tells a study from any other SQLite file.
inline constexpr int kStudyApplicationId = 0x504C4E56;
// PRAGMA user_version. Raised when a reader of the old tables would misread the new ones.
inline constexpr int kStudySchemaVersion = 1;

// The tables of an empty study.
extern const char* const kStudySchema;

// Throws InputError when the file is no study's or a newer polnav's; `remedy` ends the latter's
// message.
void CheckStudySchema(SQLite::Database& database, const std::filesystem::path& path,
                      const std::string& remedy = "");

// How a trial ended.
enum class Outcome {
  kOk,
  kFailed,       // threw
  kCrashed,      // the worker process died
  kTimeout,      // longer than time_limit_s
  kOutOfMemory,  // more than memory_limit_mb
  kInvalid,      // the scenario refuses the values that were drawn together
};

inline constexpr std::array<std::string_view, 6> kOutcomeNames{
    "ok", "failed", "crashed", "timeout", "out_of_memory", "invalid"};

[[nodiscard]] constexpr std::string_view NameOf(Outcome outcome) {
  return kOutcomeNames[static_cast<std::size_t>(outcome)];
}
[[nodiscard]] std::optional<Outcome> ParseOutcome(std::string_view name);

// In double quotes, as a column of its own name; doubles those inside.
[[nodiscard]] std::string QuotedName(std::string_view name);

}  // namespace polnav::testbed
