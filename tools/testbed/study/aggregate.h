// What do all trials of a study say together?
//
// One JSON of every statistic (docs/study_statistics.md): per case and estimator each metric's
// mean, spread and percentiles with 95 % intervals, consistency, sensitivity, paired comparisons,
// and the study's criteria. Byte-identical for the same trials, in whatever order they were run,
// on however many machines; no wall time enters.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <string>
#include <vector>

#include "tools/testbed/option_tree.h"
#include "tools/testbed/statistics/interval.h"
#include "tools/testbed/study/study_table.h"

namespace polnav::testbed {

[[nodiscard]] Json Aggregate(const StudyTable& table);
[[nodiscard]] Json Aggregate(SQLite::Database& database);

// {"value", "lower", "upper"}; what is not finite is null.
[[nodiscard]] Json ToJson(const Estimated& estimated);

// The metrics that people compare, as far as the study has them, and those of its criteria.
[[nodiscard]] std::vector<std::string> HeadlineMetrics(const StudyTable& table);

// "p05", "median": what the statistics of a metric are named, and their percents.
struct NamedPercentile {
  const char* name;
  double percent;
};
[[nodiscard]] const std::vector<NamedPercentile>& Percentiles();

// Trials beyond these are left out of sensitivities and scatter plots.
inline constexpr std::uint64_t kSensitivityTrials = 20'000;

}  // namespace polnav::testbed
