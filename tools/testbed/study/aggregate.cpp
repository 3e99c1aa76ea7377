#include "tools/testbed/study/aggregate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <future>
#include <map>
#include <string_view>

#include "tools/testbed/statistics/consistency.h"
#include "tools/testbed/statistics/mean.h"
#include "tools/testbed/statistics/paired.h"
#include "tools/testbed/statistics/percentile.h"
#include "tools/testbed/statistics/rate.h"
#include "tools/testbed/study/study_criteria.h"
#include "tools/testbed/study/study_sensitivity.h"
#include "tools/testbed/study/study_stop.h"

namespace polnav::testbed {
namespace {

constexpr std::size_t kBatch = 16;  // metrics read at once: 128 MB of a million trials

constexpr std::array<std::string_view, 8> kHeadline{
    "heading_deg.rmse", "heading_deg.max", "position_m.rmse",       "position_m.max",
    "ate_m.rmse",       "drift_percent",   "rpe_100m.trans_m.mean", "tracked_fraction"};

// What is 1 degree of freedom or more, and averages to it when honest.
double DegreesOfFreedom(const std::string& metric) {
  if (metric == "nees.position") return 3.0;
  if (metric == "nees.heading") return 1.0;
  const auto dot = metric.rfind('.');
  const std::string last = dot == std::string::npos ? metric : metric.substr(dot + 1);
  return last == "nis" || last.ends_with("_nis") ? 1.0 : 0.0;  // per degree of freedom
}

Json Number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json MetricJson(const std::vector<double>& values, std::uint64_t seed) {
  Json json = {{"n", values.size()}, {"mean", ToJson(MeanWithInterval(values, seed))}};
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  json["std"] = ToJson(SpreadWithInterval(sorted));
  json["min"] = Number(sorted.front());
  json["max"] = Number(sorted.back());
  for (const NamedPercentile& p : Percentiles()) {
    json[p.name] = ToJson(PercentileWithInterval(sorted, p.percent));
  }
  return json;
}

Json ToJson(const Consistency& c) {
  return {{"n", c.trials},
          {"honest", c.dof},
          {"mean", testbed::ToJson(c.mean)},
          {"bounds", {{"lower", Number(c.bounds.lower)}, {"upper", Number(c.bounds.upper)}}},
          {"verdict", NameOf(c.verdict)}};
}

Json ToJson(const PairedComparison& c) {
  return {{"pairs", c.pairs},
          {"lower", c.lower},
          {"higher", c.higher},
          {"mean_difference", testbed::ToJson(c.mean_difference)},
          {"median_difference", testbed::ToJson(c.median_difference)},
          {"improvement", testbed::ToJson(c.improvement)},
          {"sign_test", c.sign_test},
          {"wilcoxon", c.wilcoxon}};
}

Json CaseJson(const TableCase& c) {
  Json outcomes = Json::object();
  for (const auto& [outcome, count] : c.outcomes) outcomes[outcome] = count;
  return {{"label", c.label},
          {"scenario", c.scenario},
          {"variant", c.variant},
          {"grid", c.grid},
          {"paper", c.paper},
          {"outcomes", outcomes},
          {"ok_rate", testbed::ToJson(RateWithInterval(c.Ok(), c.Finished()))},
          {"run", Json::object()},
          {"estimators", Json::object()},
          {"paired", Json::array()}};
}

// Null when no trial yielded the metric.
Json StatisticsOf(const std::string& metric, const MetricColumn& column, std::uint64_t seed) {
  const std::vector<double> values = column.Present();
  if (values.empty()) return nullptr;
  Json json = {{"metric", MetricJson(values, seed)}};
  if (const double dof = DegreesOfFreedom(metric); dof > 0.0) {
    json["consistency"] = ToJson(CheckConsistency(values, dof, seed));
  }
  return json;
}

void AddMetrics(const StudyTable& table, const std::string& estimator, Json& cases) {
  const std::vector<std::string>& metrics = table.metrics();
  for (std::size_t first = 0; first < metrics.size(); first += kBatch) {
    const std::vector<std::string> batch(
        metrics.begin() + static_cast<std::ptrdiff_t>(first),
        metrics.begin() + static_cast<std::ptrdiff_t>(std::min(first + kBatch, metrics.size())));
    const std::vector<CaseColumns> read = table.Read(estimator, batch);
    for (std::size_t c = 0; c < read.size(); ++c) {
      if (read[c].trials.empty()) continue;
      Json& of = estimator.empty() ? cases[c]["run"] : cases[c]["estimators"][estimator];
      of["trials"] = read[c].trials.size();
      // Each metric by itself, so that threads change nothing.
      std::vector<std::future<Json>> parts;
      for (std::size_t m = 0; m < batch.size(); ++m) {
        parts.push_back(std::async(std::launch::async, StatisticsOf, std::cref(batch[m]),
                                   std::cref(read[c].columns[m]), table.seed()));
      }
      for (std::size_t m = 0; m < batch.size(); ++m) {
        Json part = parts[m].get();
        if (part.is_null()) continue;
        of["metrics"][batch[m]] = std::move(part["metric"]);
        if (part.contains("consistency")) {
          of["consistency"][batch[m]] = std::move(part["consistency"]);
        }
      }
    }
  }
}

void AddPairs(const StudyTable& table, const std::vector<std::string>& metrics, Json& cases) {
  for (std::size_t i = 0; i < table.estimators().size(); ++i) {
    if (table.estimators()[i].empty()) continue;
    const auto a = table.Read(table.estimators()[i], metrics);
    for (std::size_t j = i + 1; j < table.estimators().size(); ++j) {
      const auto b = table.Read(table.estimators()[j], metrics);
      for (std::size_t c = 0; c < a.size(); ++c) {
        for (std::size_t m = 0; m < metrics.size(); ++m) {
          const ValuePairs pairs =
              PairUp(a[c].trials, a[c].columns[m].values, b[c].trials, b[c].columns[m].values);
          if (pairs.a.empty()) continue;
          Json json = {
              {"a", table.estimators()[i]}, {"b", table.estimators()[j]}, {"metric", metrics[m]}};
          json.update(ToJson(Compare(pairs.a, pairs.b, table.seed())));
          cases[c]["paired"].push_back(json);
        }
      }
    }
  }
}

}  // namespace

const std::vector<NamedPercentile>& Percentiles() {
  static const std::vector<NamedPercentile> named{{"p05", 5.0},  {"p25", 25.0}, {"median", 50.0},
                                                  {"p75", 75.0}, {"p90", 90.0}, {"p95", 95.0},
                                                  {"p99", 99.0}};
  return named;
}

Json ToJson(const Estimated& estimated) {
  return {{"value", Number(estimated.value)},
          {"lower", Number(estimated.interval.lower)},
          {"upper", Number(estimated.interval.upper)}};
}

std::vector<std::string> HeadlineMetrics(const StudyTable& table) {
  std::vector<std::string> metrics;
  const auto add = [&](const std::string& metric) {
    if (!table.HasMetric(metric)) return;
    if (std::find(metrics.begin(), metrics.end(), metric) == metrics.end()) {
      metrics.push_back(metric);
    }
  };
  for (const std::string_view metric : kHeadline) add(std::string(metric));
  for (const StudyCriterionText& criterion : CriteriaOf(table)) add(criterion.asked.metric);
  return metrics;
}

Json Aggregate(const StudyTable& table) {
  Json cases = Json::array();
  for (const TableCase& c : table.cases()) cases.push_back(CaseJson(c));
  const std::vector<std::string> headline = HeadlineMetrics(table);
  for (const std::string& estimator : table.estimators()) AddMetrics(table, estimator, cases);
  AddPairs(table, headline, cases);
  AddSensitivities(table, headline, cases);
  std::uint64_t finished = 0;
  for (const TableCase& c : table.cases()) finished += c.Finished();
  const std::string asked = table.Meta("trials");
  const std::optional<StudyStop> stop = StopOf(table);
  const bool stopped = stop && stop->stopped_at;
  Json aggregate = {{"study", table.Meta("name")},
                    {"identity", table.Meta("identity")},
                    {"polnav_version", table.Meta("polnav_version")},
                    {"level", table.Meta("level")},
                    {"seed", table.seed()},
                    {"confidence", kConfidence},
                    {"trials", finished},
                    {"complete", stopped || asked.empty() ||
                                     finished >= std::stoull(asked) * table.cases().size()},
                    {"stop", ToJson(stop)},
                    {"cases", cases}};
  aggregate["criteria"] = Json::array();
  for (const StudyVerdict& verdict : JudgeCriteria(table)) {
    aggregate["criteria"].push_back(ToJson(verdict));
  }
  return aggregate;
}

Json Aggregate(SQLite::Database& database) { return Aggregate(StudyTable(database)); }

}  // namespace polnav::testbed
