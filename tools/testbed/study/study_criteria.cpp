#include "tools/testbed/study/study_criteria.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/testbed/result.h"
#include "tools/testbed/statistics/mean.h"
#include "tools/testbed/statistics/percentile.h"
#include "tools/testbed/statistics/rate.h"
#include "tools/testbed/study/aggregate.h"

namespace polnav::testbed {
namespace {

std::optional<double> NumberAt(const Json& json, const char* key) {
  if (!json.contains(key) || !json[key].is_number()) return std::nullopt;
  return json[key].get<double>();
}

std::string TextAt(const Json& json, const char* key) {
  return json.contains(key) && json[key].is_string() ? json[key].get<std::string>() : "";
}

bool IsAbout(const StudyCriterionText& criterion, const TableCase& c) {
  return (criterion.scenario.empty() || criterion.scenario == c.scenario) &&
         (criterion.variant.empty() || criterion.variant == c.variant);
}

// "stereo heading_deg.rmse mean <= 1.5, 95 % interval"
std::string ExpectedText(const StudyCriterionText& c) {
  std::string text = c.estimator.empty() ? "" : c.estimator + " ";
  if (!c.metric.empty()) text += c.metric + " ";
  text += c.statistic;
  if (c.success_at_least) text += fmt::format(" of >= {}", *c.success_at_least);
  if (c.success_at_most) text += fmt::format(" of <= {}", *c.success_at_most);
  if (!c.below.empty()) text += fmt::format(" of the difference to {} < 0", c.below);
  if (c.at_most) text += fmt::format(" <= {}", *c.at_most);
  if (c.at_least) text += fmt::format(" >= {}", *c.at_least);
  return c.judge == "interval" ? text + ", the whole 95 % interval" : text;
}

Estimated StatisticOf(const std::string& statistic, std::vector<double> values,
                      std::uint64_t seed) {
  if (values.empty()) return {};
  if (statistic == "mean") return MeanWithInterval(values, seed);
  std::sort(values.begin(), values.end());
  if (statistic == "std") return SpreadWithInterval(values);
  if (statistic == "min") return {values.front(), {}};
  if (statistic == "max") return {values.back(), {}};
  for (const NamedPercentile& p : Percentiles()) {
    if (statistic == p.name) return PercentileWithInterval(values, p.percent);
  }
  return {};
}

Estimated SuccessRate(const StudyCriterionText& criterion, const std::vector<double>& values) {
  const auto successes = std::count_if(values.begin(), values.end(), [&](double v) {
    return !std::isnan(v) && v >= criterion.success_at_least.value_or(-kInfinity) &&
           v <= criterion.success_at_most.value_or(kInfinity);
  });
  if (values.empty()) return {};
  const auto count = static_cast<std::uint64_t>(successes);
  return {static_cast<double>(count) / static_cast<double>(values.size()),
          ExactRateInterval(count, values.size())};
}

bool Holds(const StudyCriterionText& criterion, const Estimated& actual) {
  if (std::isnan(actual.value)) return false;
  const bool interval = criterion.judge == "interval";
  const double low = interval ? actual.interval.lower : actual.value;
  const double high = interval ? actual.interval.upper : actual.value;
  return (!criterion.at_most || high <= *criterion.at_most) &&
         (!criterion.at_least || low >= *criterion.at_least) &&
         (criterion.below.empty() || high < 0.0);
}

// Of one metric in all cases; those of no trial are empty.
std::vector<CaseColumns> ReadMetric(const StudyTable& table, const std::string& estimator,
                                    const std::string& metric) {
  if (!table.HasMetric(metric)) return std::vector<CaseColumns>(table.cases().size());
  return table.Read(estimator, {metric});
}

const std::vector<double>& ValuesOf(const CaseColumns& columns) {
  static const std::vector<double> kNone;
  return columns.columns.empty() ? kNone : columns.columns[0].values;
}

void JudgeOkRate(const StudyTable& table, std::size_t c, StudyVerdict& verdict) {
  const TableCase& the_case = table.cases()[c];
  verdict.n = the_case.Finished();
  if (verdict.n == 0) return;
  verdict.actual = {static_cast<double>(the_case.Ok()) / static_cast<double>(verdict.n),
                    ExactRateInterval(the_case.Ok(), verdict.n)};
}

}  // namespace

std::vector<StudyCriterionText> CriteriaOf(const StudyTable& table) {
  std::vector<StudyCriterionText> criteria;
  if (!table.study().contains("criteria")) return criteria;
  for (const Json& json : table.study()["criteria"]) {
    StudyCriterionText c{.name = TextAt(json, "name"),
                         .scenario = TextAt(json, "scenario"),
                         .variant = TextAt(json, "variant"),
                         .estimator = TextAt(json, "estimator"),
                         .metric = TextAt(json, "metric"),
                         .statistic = TextAt(json, "statistic"),
                         .below = TextAt(json, "below"),
                         .judge = TextAt(json, "judge"),
                         .success_at_least = NumberAt(json, "success_at_least"),
                         .success_at_most = NumberAt(json, "success_at_most"),
                         .at_most = NumberAt(json, "at_most"),
                         .at_least = NumberAt(json, "at_least")};
    if (c.statistic.empty()) c.statistic = "mean";
    criteria.push_back(std::move(c));
  }
  return criteria;
}

std::vector<StudyVerdict> JudgeCriteria(const StudyTable& table) {
  std::vector<StudyVerdict> verdicts;
  for (const StudyCriterionText& criterion : CriteriaOf(table)) {
    const auto mine = ReadMetric(table, criterion.estimator, criterion.metric);
    const auto other = criterion.below.empty()
                           ? std::vector<CaseColumns>(mine.size())
                           : ReadMetric(table, criterion.below, criterion.metric);
    for (std::size_t c = 0; c < table.cases().size(); ++c) {
      if (!IsAbout(criterion, table.cases()[c])) continue;
      StudyVerdict verdict{.name = criterion.name,
                           .label = table.cases()[c].label,
                           .expected = ExpectedText(criterion)};
      if (criterion.statistic == "ok_rate") {
        JudgeOkRate(table, c, verdict);
      } else if (criterion.statistic == "success_rate") {
        verdict.n = ValuesOf(mine[c]).size();
        verdict.actual = SuccessRate(criterion, ValuesOf(mine[c]));
      } else if (criterion.below.empty()) {
        std::vector<double> values = MetricColumn{ValuesOf(mine[c])}.Present();
        verdict.n = values.size();
        verdict.actual = StatisticOf(criterion.statistic, std::move(values), table.seed());
      } else {
        ValuePairs pairs =
            PairUp(mine[c].trials, ValuesOf(mine[c]), other[c].trials, ValuesOf(other[c]));
        for (std::size_t i = 0; i < pairs.a.size(); ++i) pairs.a[i] -= pairs.b[i];
        verdict.n = pairs.a.size();
        verdict.actual = StatisticOf(criterion.statistic, std::move(pairs.a), table.seed());
      }
      verdict.passed = Holds(criterion, verdict.actual);
      verdicts.push_back(std::move(verdict));
    }
  }
  return verdicts;
}

Json ToJson(const StudyVerdict& verdict) {
  return {{"name", verdict.name},
          {"case", verdict.label},
          {"expected", verdict.expected},
          {"n", verdict.n},
          {"actual", ToJson(verdict.actual)},
          {"passed", verdict.passed}};
}

bool AllCriteriaHold(const Json& aggregate) {
  return std::all_of(aggregate["criteria"].begin(), aggregate["criteria"].end(),
                     [](const Json& c) { return c["passed"].get<bool>(); });
}

std::string StudyJUnitXml(const Json& aggregate) {
  const Json& criteria = aggregate["criteria"];
  const auto failures = std::count_if(criteria.begin(), criteria.end(),
                                      [](const Json& c) { return !c["passed"].get<bool>(); });
  const std::string suite = EscapeMarkup(aggregate["study"].get<std::string>());
  std::string xml = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
      "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"0\">\n",
      suite, criteria.size(), failures);
  for (const Json& c : criteria) {
    const std::string name =
        c["name"].get<std::string>() + " [" + c["case"].get<std::string>() + "]";
    xml +=
        fmt::format("    <testcase classname=\"polnav.{}\" name=\"{}\"", suite, EscapeMarkup(name));
    if (c["passed"].get<bool>()) {
      xml += "/>\n";
      continue;
    }
    const Json& actual = c["actual"];
    const std::string got = actual["value"].is_null()
                                ? "no value"
                                : fmt::format("{} [{}, {}] of {} values", actual["value"].dump(),
                                              actual["lower"].dump(), actual["upper"].dump(),
                                              c["n"].get<std::size_t>());
    xml +=
        fmt::format(">\n      <failure message=\"{}\"/>\n    </testcase>\n",
                    EscapeMarkup("expected " + c["expected"].get<std::string>() + ", got " + got));
  }
  return xml + "  </testsuite>\n</testsuites>\n";
}

}  // namespace polnav::testbed
