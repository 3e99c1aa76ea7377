// Can the criteria of a study be judged, and is what it stops by what its trials yield?
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "tools/testbed/metrics.h"
#include "tools/testbed/option_loader.h"
#include "tools/testbed/statistics/stopping.h"
#include "tools/testbed/study/study_checks.h"

namespace polnav::testbed {
namespace {

void CheckCriterionMetric(const YamlDocument& document, const std::string& key,
                          const StudyCriterion& criterion) {
  if (criterion.statistic == "ok_rate") return;
  if (IsMetric(fmt::format("estimators.{}.{}", criterion.estimator, criterion.metric))) return;
  const std::string nearest = NearestWord(criterion.metric, EstimatorMetrics());
  FailAt(document, key + ".metric",
         fmt::format("'{}' is no metric of '{}'{} (polnav list shows all)", criterion.metric,
                     criterion.estimator,
                     nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
}

// Of a criterion or of what a study stops by.
template <typename Options>
void CheckSuccess(const YamlDocument& document, const std::string& key, const Options& c) {
  const bool limits = c.success_at_least || c.success_at_most;
  if (c.statistic == "success_rate" && !limits) {
    FailAt(document, key, "success_rate needs success_at_most or success_at_least");
  }
  if (c.statistic != "success_rate" && limits) {
    FailAt(document, key + ".statistic", "success_at_* belong to success_rate");
  }
}

void CheckCriterionLimits(const YamlDocument& document, const std::string& key,
                          const StudyCriterion& c) {
  if (!c.at_most && !c.at_least && c.below.empty()) {
    FailAt(document, key, "a criterion needs at_most, at_least or below");
  }
  CheckSuccess(document, key, c);
  if (c.judge == "interval" && (c.statistic == "min" || c.statistic == "max")) {
    FailAt(document, key + ".judge",
           fmt::format("'{}' of the trials has no 95 % interval: use judge: value, or a percentile",
                       c.statistic));
  }
  const bool rate = c.statistic == "ok_rate" || c.statistic == "success_rate";
  if (rate && !c.below.empty()) {
    FailAt(document, key + ".below", "rates are not compared in pairs: use at_least or at_most");
  }
}

// The cases a criterion is about run the estimators that it names.
void CheckCriterionCases(const YamlDocument& document, const std::string& key,
                         const StudyCriterion& criterion, const std::vector<StudyCase>& cases) {
  bool any = false;
  for (const StudyCase& c : cases) {
    if (!criterion.scenario.empty() && criterion.scenario != c.scenario) continue;
    if (!criterion.variant.empty() && criterion.variant != c.variant) continue;
    any = true;
    for (const std::string& name : {criterion.estimator, criterion.below}) {
      const bool runs =
          std::find(c.estimators.begin(), c.estimators.end(), name) != c.estimators.end();
      if (runs || name.empty()) continue;
      const std::string nearest = NearestWord(name, c.estimators);
      FailAt(document, key,
             fmt::format("estimator '{}' is not run in {}{}", name, c.label,
                         nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
    }
  }
  if (!any) FailAt(document, key, "no case is of this scenario and variant");
}

}  // namespace

void CheckStudyCriteria(const YamlDocument& document, const std::vector<StudyCriterion>& criteria,
                        const std::vector<StudyCase>& cases) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < criteria.size(); ++i) {
    const StudyCriterion& criterion = criteria[i];
    const std::string key = fmt::format("criteria.{}", i);
    if (criterion.name.empty()) FailAt(document, key, "a criterion needs a name");
    if (!names.insert(criterion.name).second) {
      FailAt(document, key + ".name", fmt::format("'{}' is given twice", criterion.name));
    }
    const bool about_runs = criterion.statistic == "ok_rate";
    if (!about_runs && criterion.estimator.empty()) {
      FailAt(document, key, "a criterion needs an estimator");
    }
    CheckCriterionCases(document, key, criterion, cases);
    CheckCriterionMetric(document, key, criterion);
    CheckCriterionLimits(document, key, criterion);
  }
}

namespace {

void CheckStopSampling(const YamlDocument& document, const StudyOptions& options) {
  if (options.sampling != "random") {
    FailAt(document, "stop",
           fmt::format("needs sampling: random: the intervals that it goes by are of independent "
                       "trials, and those of {} scatter otherwise",
                       options.sampling));
  }
  if (static_cast<std::size_t>(options.trials) <= kFirstLook) {
    FailAt(document, "stop",
           fmt::format("the first look is after {} trials: expected more than so many in trials, "
                       "the most that are run of each case (it is {})",
                       kFirstLook, options.trials));
  }
}

}  // namespace

void CheckStudyStop(const YamlDocument& document, const StudyOptions& options,
                    const std::vector<StudyCase>& cases) {
  if (options.stop.empty()) return;
  CheckStopSampling(document, options);
  for (std::size_t i = 0; i < options.stop.size(); ++i) {
    const StudyStopOptions& stop = options.stop[i];
    const std::string key = fmt::format("stop.{}", i);
    if (stop.estimator.empty()) FailAt(document, key, "expected an estimator and its metric");
    if (stop.half_width.has_value() == stop.relative_half_width.has_value()) {
      FailAt(document, key, "expected half_width or relative_half_width");
    }
    if (stop.statistic == "success_rate" && !stop.minus.empty()) {
      FailAt(document, key + ".minus", "rates are not compared in pairs");
    }
    StudyCriterion criterion;
    criterion.scenario = stop.scenario;
    criterion.variant = stop.variant;
    criterion.estimator = stop.estimator;
    criterion.below = stop.minus;
    criterion.metric = stop.metric;
    criterion.statistic = stop.statistic;
    CheckCriterionCases(document, key, criterion, cases);
    CheckCriterionMetric(document, key, criterion);
    CheckSuccess(document, key, stop);
  }
}

}  // namespace polnav::testbed
