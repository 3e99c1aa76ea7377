// What is a statistic of a study, by the names that study files give it?
//
// Of one metric of an estimator over the trials of a case that went ok, or of its paired difference
// to another estimator. mean, median, std, min, max, p05 ... p99 with their 95 % intervals (min and
// max have none); success_rate with Clopper and Pearson's, where a trial that did not yield the
// metric is no success.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/testbed/statistics/interval.h"
#include "tools/testbed/study/study_table.h"

namespace polnav::testbed {

struct StudyStatistic {
  std::string scenario;  // of which cases; empty: all
  std::string variant;
  std::string estimator;
  std::string minus;  // another estimator: of the difference to it in the same trial
  std::string metric;
  std::string statistic;
  std::optional<double> success_at_least, success_at_most;
};

// Nothing where there is no such key, or no number.
[[nodiscard]] std::optional<double> NumberAt(const Json& json, const char* key);

// From an entry of a list in a study's definition; what has no such key stays empty.
[[nodiscard]] StudyStatistic ParseStudyStatistic(const Json& json);

[[nodiscard]] bool IsAbout(const StudyStatistic& asked, const TableCase& c);

// "stereo heading_deg.rmse mean".
[[nodiscard]] std::string NameOf(const StudyStatistic& asked);

// Of one case, in order of trials; NaN where a trial did not yield the metric.
struct TrialValues {
  std::vector<std::uint64_t> trials;
  std::vector<double> values;
};

// One entry a case.
[[nodiscard]] std::vector<TrialValues> ReadValues(const StudyTable& table,
                                                  const StudyStatistic& asked);

// Without any value: NaN. n: how many it is of.
struct StatisticOfTrials {
  Estimated actual;
  std::size_t n = 0;
};
[[nodiscard]] StatisticOfTrials Compute(const StudyStatistic& asked, std::span<const double> values,
                                        std::uint64_t seed);

}  // namespace polnav::testbed
