#include "tools/testbed/study/study_statistic.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/testbed/statistics/mean.h"
#include "tools/testbed/statistics/percentile.h"
#include "tools/testbed/statistics/rate.h"
#include "tools/testbed/study/aggregate.h"

namespace polnav::testbed {
namespace {

std::string TextAt(const Json& json, const char* key) {
  return json.contains(key) && json[key].is_string() ? json[key].get<std::string>() : "";
}

StatisticOfTrials SuccessRate(const StudyStatistic& asked, std::span<const double> values) {
  if (values.empty()) return {};
  const auto count =
      static_cast<std::uint64_t>(std::count_if(values.begin(), values.end(), [&](double v) {
        return !std::isnan(v) && v >= asked.success_at_least.value_or(-kInfinity) &&
               v <= asked.success_at_most.value_or(kInfinity);
      }));
  const double share = static_cast<double>(count) / static_cast<double>(values.size());
  return {{share, ExactRateInterval(count, values.size())}, values.size()};
}

Estimated OfPresent(const std::string& statistic, std::vector<double> values, std::uint64_t seed) {
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

std::vector<TrialValues> ReadMetric(const StudyTable& table, const std::string& estimator,
                                    const std::string& metric) {
  std::vector<TrialValues> of_cases(table.cases().size());
  if (!table.HasMetric(metric)) return of_cases;
  std::vector<CaseColumns> read = table.Read(estimator, {metric});
  for (std::size_t c = 0; c < read.size(); ++c) {
    of_cases[c] = {std::move(read[c].trials), std::move(read[c].columns[0].values)};
  }
  return of_cases;
}

}  // namespace

std::optional<double> NumberAt(const Json& json, const char* key) {
  if (!json.contains(key) || !json[key].is_number()) return std::nullopt;
  return json[key].get<double>();
}

StudyStatistic ParseStudyStatistic(const Json& json) {
  return {.scenario = TextAt(json, "scenario"),
          .variant = TextAt(json, "variant"),
          .estimator = TextAt(json, "estimator"),
          .minus = TextAt(json, "minus"),
          .metric = TextAt(json, "metric"),
          .statistic = TextAt(json, "statistic"),
          .success_at_least = NumberAt(json, "success_at_least"),
          .success_at_most = NumberAt(json, "success_at_most")};
}

bool IsAbout(const StudyStatistic& asked, const TableCase& c) {
  return (asked.scenario.empty() || asked.scenario == c.scenario) &&
         (asked.variant.empty() || asked.variant == c.variant);
}

std::string NameOf(const StudyStatistic& asked) {
  std::string text = asked.estimator.empty() ? "" : asked.estimator + " ";
  if (!asked.metric.empty()) text += asked.metric + " ";
  text += asked.statistic;
  if (asked.success_at_least) text += fmt::format(" of >= {}", *asked.success_at_least);
  if (asked.success_at_most) text += fmt::format(" of <= {}", *asked.success_at_most);
  if (!asked.minus.empty()) text += fmt::format(" of the difference to {}", asked.minus);
  return text;
}

std::vector<TrialValues> ReadValues(const StudyTable& table, const StudyStatistic& asked) {
  std::vector<TrialValues> read = ReadMetric(table, asked.estimator, asked.metric);
  if (asked.minus.empty()) return read;
  const std::vector<TrialValues> other = ReadMetric(table, asked.minus, asked.metric);
  for (std::size_t c = 0; c < read.size(); ++c) {
    ValuePairs pairs = PairUp(read[c].trials, read[c].values, other[c].trials, other[c].values);
    for (std::size_t i = 0; i < pairs.a.size(); ++i) pairs.a[i] -= pairs.b[i];
    read[c] = {std::move(pairs.trials), std::move(pairs.a)};
  }
  return read;
}

StatisticOfTrials Compute(const StudyStatistic& asked, std::span<const double> values,
                          std::uint64_t seed) {
  if (asked.statistic == "success_rate") return SuccessRate(asked, values);
  std::vector<double> present;
  std::copy_if(values.begin(), values.end(), std::back_inserter(present),
               [](double v) { return !std::isnan(v); });
  const std::size_t n = present.size();
  return {OfPresent(asked.statistic, std::move(present), seed), n};
}

}  // namespace polnav::testbed
