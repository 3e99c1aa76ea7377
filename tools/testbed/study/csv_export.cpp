#include "tools/testbed/study/csv_export.h"

#include <fmt/format.h>

#include <array>

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

namespace {

constexpr std::array<const char*, 9> kIntervals{"mean", "std", "p05", "p25", "median",
                                                "p75",  "p90", "p95", "p99"};

std::string Number(const Json& value) {
  return value.is_number() ? fmt::format("{}", value.get<double>()) : "";
}

void WriteSummaryRow(const std::string& start, const std::string& metric, const Json& of,
                     std::ostream& out) {
  out << start << Field(metric) << ',' << of["n"].dump();
  for (const char* statistic : kIntervals) {
    for (const char* part : {"value", "lower", "upper"}) out << ',' << Number(of[statistic][part]);
  }
  out << ',' << Number(of["min"]) << ',' << Number(of["max"]) << '\n';
}

}  // namespace

void WriteSummaryCsv(const Json& aggregate, std::ostream& out) {
  out << "case,estimator,metric,n";
  for (const char* statistic : kIntervals) {
    out << fmt::format(",{0},{0}_lower,{0}_upper", statistic);
  }
  out << ",min,max\n";
  for (const Json& c : aggregate["cases"]) {
    const std::string label = Field(c["label"].get<std::string>()) + ",";
    for (const auto& [name, of] : c["estimators"].items()) {
      if (!of.contains("metrics")) continue;
      for (const auto& [metric, statistics] : of["metrics"].items()) {
        WriteSummaryRow(label + Field(name) + ",", metric, statistics, out);
      }
    }
    for (const auto& [metric, figures] : c["paper"].items()) {
      for (const Json& figure : figures) {
        // 28 fields follow the mean: two ends, eight other statistics, min and max.
        out << label << Field(figure["label"].get<std::string>()) << ',' << metric << ",1,"
            << Number(figure["value"]) << std::string(28, ',') << '\n';
      }
    }
  }
}

}  // namespace polnav::testbed
