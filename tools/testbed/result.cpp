#include "tools/testbed/result.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/testbed/hash.h"
#include "tools/testbed/metrics.h"
#include "tools/testbed/score.h"
#include "tools/testbed/statistics.h"

namespace polnav::testbed {
namespace {

Json ToJson(const OutcomeCounts& counts) {
  return {{"used", counts.used},
          {"gated", counts.gated},
          {"unusable", counts.unusable},
          {"ignored", counts.ignored},
          {"keyframes", counts.keyframes},
          {"features", counts.features},
          {"inliers", counts.inliers},
          {"flow_rejected", counts.flow_rejected},
          {"pose_rejected", counts.pose_rejected},
          {"map_rejected", counts.map_rejected},
          {"imu_wrong", counts.imu_wrong},
          {"pictures_wrong", counts.pictures_wrong},
          {"returns", counts.returns},
          {"gated_readings", counts.gated_readings},
          {"failed_solves", counts.failed_solves}};
}

// A compass that finds no heading in a picture answers nothing.
double AnsweredFraction(const OutcomeCounts& counts) {
  const auto asked = static_cast<double>(counts.used + counts.gated + counts.unusable);
  return asked > 0.0 ? static_cast<double>(counts.used) / asked : 0.0;
}

Json EstimatorJson(const EstimatorRun& run, const RunRecord& record, const Trajectory& truth) {
  Json json = {{"sha256", run.sha256}};
  if (const Json diagnostics = testbed::ToJson(run.diagnostics); !diagnostics.is_null()) {
    json["diagnostics"] = diagnostics;
  }
  if (const Json nis = NisJson(run.diagnostics); !nis.is_null()) json["nis"] = nis;
  json["measurements"] = ToJson(run.counts);
  if (truth.empty()) return json;  // nothing to score against
  // No answer at all leaves every metric out: criteria about it fail.
  if (const auto score = Score(truth, run.estimates, run.heading_only, record.disturbed)) {
    json.update(testbed::ToJson(*score));
    if (run.heading_only) json["tracked_fraction"] = AnsweredFraction(run.counts);
  } else {
    json["tracked_fraction"] = 0.0;
  }
  if (const auto biases = ScoreBiases(record.truth, run.estimates)) {
    json["biases"] = testbed::ToJson(*biases);
  }
  if (run.alignment != Alignment::kNone) {
    json["alignment"] = NameOf(run.alignment);
    json["nees"] = nullptr;  // the alignment took away some of what the covariance stands for
  }
  return json;
}

Json TimingJson(const std::map<std::string, StageTiming>& timing) {
  Json json = Json::object();
  for (const auto& [stage, times] : timing) {
    if (times.ms.empty()) continue;
    json[stage] = {{"median", Percentile(times.ms, 50.0)}, {"p99", Percentile(times.ms, 99.0)}};
  }
  return json;
}

bool WasRun(const Scenario& scenario, const std::string& metric) {
  const std::string estimator = EstimatorOfMetric(metric);
  const auto& run = scenario.estimators.run;
  return estimator.empty() || std::find(run.begin(), run.end(), estimator) != run.end();
}

CriterionResult Evaluate(const Scenario& scenario, const Criterion& criterion, const Json& result) {
  CriterionResult outcome{.name = criterion.name, .expected = criterion.metric, .actual = {}};
  std::string separator = " ";
  const auto expect = [&](const std::string& text) {
    outcome.expected += separator + text;
    separator = " and ";
  };
  outcome.actual = MetricAt(result, criterion.metric);
  bool holds = outcome.actual.has_value();
  const double actual = outcome.actual.value_or(0.0);
  if (criterion.at_most) {
    expect(fmt::format("<= {}", *criterion.at_most));
    holds = holds && actual <= *criterion.at_most;
  }
  if (criterion.at_least) {
    expect(fmt::format(">= {}", *criterion.at_least));
    holds = holds && actual >= *criterion.at_least;
  }
  if (!criterion.below.empty()) {
    const std::optional<double> other = MetricAt(result, criterion.below);
    expect(
        fmt::format("< {} ({})", criterion.below, other ? fmt::format("{:.6g}", *other) : "none"));
    holds = holds && other && actual < *other;
  }
  const bool run = WasRun(scenario, criterion.metric) && WasRun(scenario, criterion.below);
  outcome.verdict = !run ? Verdict::kSkipped : holds ? Verdict::kPassed : Verdict::kFailed;
  return outcome;
}

Json ToJson(const CriterionResult& criterion) {
  Json json = {{"name", criterion.name},
               {"expected", criterion.expected},
               {"actual", criterion.actual ? Json(*criterion.actual) : Json(nullptr)},
               {"passed", criterion.verdict == Verdict::kPassed}};
  if (criterion.verdict == Verdict::kSkipped) {
    json["passed"] = nullptr;
    json["skipped"] = "the estimator was not run";
  }
  return json;
}

}  // namespace

std::string EscapeMarkup(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        // XML 1.0 admits no other control characters, not even as entities.
        if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') escaped += c;
    }
  }
  return escaped;
}

std::vector<CriterionResult> EvaluateCriteria(const Scenario& scenario, const Json& result) {
  std::vector<CriterionResult> outcomes;
  for (const Criterion& criterion : scenario.criteria) {
    outcomes.push_back(Evaluate(scenario, criterion, result));
  }
  return outcomes;
}

Json BuildResult(const Scenario& scenario, const RunRecord& record, std::uint64_t seed,
                 const std::string& level) {
  Json result;
  result["scenario"] = scenario.name;
  result["scenario_sha256"] = Sha256Of(ResolvedYaml(scenario));
  result["seed"] = seed;
  result["level"] = level;
  result["sim_duration_s"] = record.sim_duration_s;
  result["wall_s"] = record.wall_s;
  result["real_time_factor"] = record.wall_s > 0.0 ? record.sim_duration_s / record.wall_s : 0.0;
  result["peak_rss_mb"] = record.peak_rss_mb;
  result["streams"] = Json::object();
  for (const auto& [name, stream] : record.streams) {
    result["streams"][name] = {{"count", stream.count}, {"sha256", stream.sha256}};
  }
  result["timing_ms"] = TimingJson(record.timing);
  if (!record.polarization_readings.empty()) {
    std::vector<double> errors_deg;
    for (const HeadingReading& r : record.polarization_readings) {
      errors_deg.push_back(nav::RadToDeg(r.error_rad));
    }
    result["polarization_reading_deg"] = ToJson(Summarize(errors_deg));
  }
  result["estimators"] = Json::object();
  const Trajectory truth = TrajectoryOf(record.truth);
  for (const EstimatorRun& run : record.estimators) {
    result["estimators"][run.name] = EstimatorJson(run, record, truth);
  }
  const std::vector<CriterionResult> criteria = EvaluateCriteria(scenario, result);
  result["criteria"] = Json::array();
  for (const CriterionResult& criterion : criteria) result["criteria"].push_back(ToJson(criterion));
  return result;
}

bool AllPassed(const std::vector<CriterionResult>& criteria) {
  return std::none_of(criteria.begin(), criteria.end(), [](const CriterionResult& criterion) {
    return criterion.verdict == Verdict::kFailed;
  });
}

std::string JUnitXml(const Scenario& scenario, const Json& result,
                     const std::vector<CriterionResult>& criteria) {
  const auto count = [&](Verdict verdict) {
    return std::count_if(criteria.begin(), criteria.end(),
                         [&](const CriterionResult& c) { return c.verdict == verdict; });
  };
  const std::string suite = EscapeMarkup(scenario.name);
  std::string xml = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
      "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"{}\" "
      "time=\"{:.3f}\">\n",
      suite, criteria.size(), count(Verdict::kFailed), count(Verdict::kSkipped),
      result.value("wall_s", 0.0));
  for (const CriterionResult& c : criteria) {
    xml += fmt::format("    <testcase classname=\"polnav.{}\" name=\"{}\"", suite,
                       EscapeMarkup(c.name));
    const std::string message =
        EscapeMarkup(fmt::format("expected {}, got {}", c.expected,
                                 c.actual ? fmt::format("{:.6g}", *c.actual) : "no value"));
    if (c.verdict == Verdict::kFailed) {
      xml += fmt::format(">\n      <failure message=\"{}\"/>\n    </testcase>\n", message);
    } else if (c.verdict == Verdict::kSkipped) {
      xml += ">\n      <skipped message=\"the estimator was not run\"/>\n    </testcase>\n";
    } else {
      xml += "/>\n";
    }
  }
  return xml + "  </testsuite>\n</testsuites>\n";
}

}  // namespace polnav::testbed
