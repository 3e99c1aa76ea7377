#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "tools/polnav/commands.h"
#include "tools/polnav/study_summary.h"
#include "tools/testbed/input_error.h"
#include "tools/testbed/report/study_report.h"
#include "tools/testbed/study/aggregate.h"
#include "tools/testbed/study/csv_export.h"
#include "tools/testbed/study/schema.h"
#include "tools/testbed/study/study_criteria.h"

namespace polnav::testbed {
namespace {

namespace fs = std::filesystem;

void WriteFile(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  std::ofstream file(path, std::ios::binary);
  if (file) write(file);
  file.close();
  if (!file) {
    throw InputError(path.string(), 0, "",
                     "cannot be written: is there such a folder, and room on the disk?");
  }
}

int ReportStudy(const ReportArguments& arguments, const fs::path& path, const Console& console) {
  // One thread reads; sqlite3's locks for several are a tenth of the time of a million trials.
  SQLite::Database db(path.string(), SQLite::OPEN_READONLY | SQLite::OPEN_NOMUTEX, 10'000);
  CheckStudySchema(db, path);
  // What is read is one state of the file, also while the study goes on.
  SQLite::Transaction snapshot(db);
  const StudyTable table(db);
  const Json aggregate = Aggregate(table);
  fs::path html = arguments.out;
  if (html.empty()) html = fs::path(path).replace_extension(".html");
  WriteFile(html, [&](std::ostream& out) { out << StudyHtml(table, aggregate); });
  WriteFile(fs::path(html).replace_extension(".junit.xml"),
            [&](std::ostream& out) { out << StudyJUnitXml(aggregate); });
  if (!arguments.csv.empty()) {
    WriteFile(arguments.csv, [&](std::ostream& out) { WriteCsv(table, out); });
  }
  if (!arguments.summary_csv.empty()) {
    WriteFile(arguments.summary_csv, [&](std::ostream& out) { WriteSummaryCsv(aggregate, out); });
  }
  if (arguments.json) {
    console.out << aggregate.dump(2) << "\n";
  } else if (!arguments.quiet) {
    console.out << StudySummary(aggregate) << html.string() << "\n";
  } else {
    console.err << StudyCriteriaText(aggregate, true);
  }
  return AllCriteriaHold(aggregate) ? kExitHolds : kExitCriterionFailed;
}

// A run has written its report; this says where, and whether it kept its promises.
int ReportRun(const fs::path& folder, const Console& console) {
  std::ifstream file(folder / "result.json");
  const Json result = Json::parse(file, nullptr, false);
  if (!file || !result.is_object()) {
    throw InputError((folder / "result.json").string(), 0, "",
                     "is not there or not readable: expected the folder of a run");
  }
  int code = kExitHolds;
  for (const Json& c : result.value("criteria", Json::array())) {
    const bool failed = c.contains("passed") && c["passed"] == Json(false);
    if (!failed) continue;
    code = kExitCriterionFailed;
    console.out << "FAILS  " << c["name"].get<std::string>() << ": expected "
                << c["expected"].get<std::string>() << "\n";
  }
  console.out << (folder / "report.html").string() << "\n";
  return code;
}

}  // namespace

int Report(const ReportArguments& arguments, const Console& console) {
  const fs::path path = arguments.path;
  if (!fs::exists(path)) throw InputError(path.string(), 0, "", "no such file or folder");
  if (fs::is_directory(path)) return ReportRun(path, console);
  try {
    return ReportStudy(arguments, path, console);
  } catch (const SQLite::Exception& error) {
    throw InputError(path.string(), 0, "",
                     fmt::format("cannot be read as the result file of a study: {}", error.what()));
  }
}

}  // namespace polnav::testbed
