// Did the study keep its promises?
//
// A criterion is about one statistic over the trials of a case that went ok, and is judged in every
// case that it is about. `below` is about the paired differences to another estimator. Judged by
// the value that was measured, or with `judge: interval` by the whole 95 % interval (rates: Clopper
// and Pearson's); an end that is unbounded then fails. Where no criterion is about the ok_rate of a
// case, every trial of it must go ok.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/testbed/option_tree.h"
#include "tools/testbed/statistics/interval.h"
#include "tools/testbed/study/study_statistic.h"
#include "tools/testbed/study/study_table.h"

namespace polnav::testbed {

// As the result file's definition has it.
struct StudyCriterionText {
  std::string name;
  StudyStatistic asked;
  bool below = false;  // asked.minus: less than it
  std::string judge;
  std::optional<double> at_most, at_least;
};

// Those of the study file.
[[nodiscard]] std::vector<StudyCriterionText> CriteriaOf(const StudyTable& table);

struct StudyVerdict {
  std::string name;
  std::string label;     // of the case
  std::string expected;  // for people
  std::size_t n = 0;     // values that it is judged by
  Estimated actual;      // NaN: the study did not yield it, which fails
  bool passed = false;
};

[[nodiscard]] std::vector<StudyVerdict> JudgeCriteria(const StudyTable& table);
[[nodiscard]] Json ToJson(const StudyVerdict& verdict);

// From the aggregate.
[[nodiscard]] bool AllCriteriaHold(const Json& aggregate);
[[nodiscard]] std::string StudyJUnitXml(const Json& aggregate);

}  // namespace polnav::testbed
