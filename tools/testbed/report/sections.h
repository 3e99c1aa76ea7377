// How does each part of the report read? HTML fragments; text from outside is escaped here.
#pragma once

#include <string>
#include <vector>

#include "tools/testbed/report.h"

namespace polnav::testbed {

// Some estimator answers more than a heading.
[[nodiscard]] bool HasPositions(const ReportInput& input);

// "not aligned", "aligned to the truth (se3)".
[[nodiscard]] std::string AlignmentText(const RunRecord& record);

[[nodiscard]] std::string HeaderSection(const ReportInput& input);
[[nodiscard]] std::string ChartSections(const ReportInput& input);
[[nodiscard]] std::string DiagnosticSections(const ReportInput& input);
[[nodiscard]] std::string ErrorSections(const ReportInput& input);
[[nodiscard]] std::string CriteriaSection(const ReportInput& input);
[[nodiscard]] std::string FaultSection(const ReportInput& input);  // empty without faults
[[nodiscard]] std::string PictureSection(const ReportInput& input);
[[nodiscard]] std::string TimingAndStreamSections(const ReportInput& input);
[[nodiscard]] std::string AgainSection(const ReportInput& input);  // how to run it again

// A card with a canvas; nothing is escaped.
[[nodiscard]] std::string ChartCard(const std::string& id, const std::string& title,
                                    const std::string& note, const std::string& shape = "chart");

// Cells are escaped; the first row is the header. row_class: of each row after it, may be short.
struct HtmlTable {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> row_class;
  bool text_columns = false;  // left-aligned, wrapping

  [[nodiscard]] std::string Html() const;
};

// JSON for inside a script, which it must not be able to end.
[[nodiscard]] std::string ScriptSafe(const Json& data);

}  // namespace polnav::testbed
