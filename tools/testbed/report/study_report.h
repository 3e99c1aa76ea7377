// What would a person want to see of a study?
//
// One HTML file that needs nothing else: how the trials ended, each estimator's errors with 95 %
// intervals beside the paper's, who is better and how sure that is, distributions with their bands,
// errors over time with percentiles, what each input does, the worst trials and how to run each of
// them again. Charts are drawn for the first kChartedCases cases, and thinned.
#pragma once

#include <string>
#include <vector>

#include "tools/testbed/option_tree.h"
#include "tools/testbed/study/study_table.h"

namespace polnav::testbed {

inline constexpr std::size_t kChartedCases = 12;

// aggregate: of the same table.
[[nodiscard]] std::string StudyHtml(const StudyTable& table, const Json& aggregate);

// What the charts draw: study.cases[] with cdfs, series, scatters.
[[nodiscard]] Json StudyChartData(const StudyTable& table);

// HTML fragments; text from outside is escaped.
[[nodiscard]] std::string StudyHeader(const StudyTable& table, const Json& aggregate);
[[nodiscard]] std::string StudyStopSection(const Json& aggregate);
[[nodiscard]] std::string StudyCriteriaSection(const Json& aggregate);
[[nodiscard]] std::string StudyErrorSections(const StudyTable& table, const Json& aggregate);
[[nodiscard]] std::string StudyPairSection(const Json& aggregate);
[[nodiscard]] std::string StudyConsistencySection(const Json& aggregate);
[[nodiscard]] std::string StudySensitivitySection(const Json& aggregate);
[[nodiscard]] std::string StudyWorstSection(const StudyTable& table);
[[nodiscard]] std::string StudyFailureSection(const StudyTable& table);

// "1.23 [1.10, 1.40]" of {"value", "lower", "upper"}; four digits.
[[nodiscard]] std::string IntervalText(const Json& estimated, double scale = 1.0);

// "polnav study FILE --trial K".
[[nodiscard]] std::string RerunCommand(const StudyTable& table, std::uint64_t trial);

}  // namespace polnav::testbed
