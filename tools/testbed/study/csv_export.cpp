#include "tools/testbed/study/csv_export.h"

#include <fmt/format.h>

#include "tools/testbed/study/schema.h"

namespace polnav::testbed {
namespace {

// In quotes where a comma or a quote would be misread (RFC 4180).
std::string Field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  return QuotedName(text);
}

}  // namespace

void WriteCsv(const StudyTable& table, std::ostream& out) {
  out << "trial,case,sample,estimator,metric,value\n";
  if (table.metrics().empty()) return;
  std::vector<std::string> labels;
  for (const TableCase& c : table.cases()) labels.push_back(Field(c.label));
  std::string sql = "SELECT estimator, trial";
  for (const std::string& metric : table.metrics()) sql += ", " + QuotedName(metric);
  SQLite::Statement query(table.connection(), sql + " FROM scores ORDER BY estimator, trial");
  while (query.executeStep()) {
    const std::string estimator = Field(query.getColumn(0).getString());
    const auto trial = static_cast<std::uint64_t>(query.getColumn(1).getInt64());
    const std::string start = fmt::format("{},{},{},{},", trial, labels[table.CaseOf(trial)],
                                          trial / labels.size(), estimator);
    for (std::size_t m = 0; m < table.metrics().size(); ++m) {
      const SQLite::Column value = query.getColumn(static_cast<int>(m) + 2);
      if (value.isNull()) continue;
      out << start << table.metrics()[m] << ',' << fmt::format("{}", value.getDouble()) << '\n';
    }
  }
}

}  // namespace polnav::testbed
