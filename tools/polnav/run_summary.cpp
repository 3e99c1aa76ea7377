#include "tools/polnav/run_summary.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/polnav/console.h"
#include "tools/testbed/metrics.h"
#include "tools/testbed/paper_tables.h"

namespace polnav::testbed {
namespace {

std::string Number(const Json& tree, const std::string& path, int digits) {
  const std::optional<double> value = MetricAt(tree, path);
  return value ? fmt::format("{:.{}f}", *value, digits) : "-";
}

std::string Fixed(std::optional<double> value) {
  return value ? fmt::format("{:.2f}", *value) : "-";
}

// One table of errors beside the paper's. mean: the path of the mean that is shown.
std::string ErrorTable(const char* title, const Json& result, const std::string& errors,
                       const std::string& mean, const PaperTable& paper) {
  TextTable table({title, "max", "mean", "RMSE", "std"});
  for (const auto& [name, scores] : result["estimators"].items()) {
    table.Add({name, Number(scores, errors + ".max", 3), Number(scores, errors + "." + mean, 3),
               Number(scores, errors + ".rmse", 3), Number(scores, errors + ".std", 3)});
  }
  for (const PaperRow& row : paper.rows) {
    table.Add({fmt::format("  {}: {}", paper.paper, row.label), Fixed(row.max), Fixed(row.mean),
               Fixed(row.rmse), Fixed(row.std)});
  }
  return table.Text() + "\n";
}

bool AnyPosition(const Json& result) {
  return std::any_of(result["estimators"].begin(), result["estimators"].end(),
                     [](const Json& scores) { return MetricAt(scores, "position_m.rmse"); });
}

std::string VerdictText(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPassed:
      return "PASS";
    case Verdict::kFailed:
      return "FAIL";
    case Verdict::kSkipped:
      return "SKIP";
  }
  return "";
}

std::string CriterionLine(const CriterionResult& c) {
  return fmt::format("  {}  {}: {}, got {}\n", VerdictText(c.verdict), c.name, c.expected,
                     c.actual ? fmt::format("{:.6g}", *c.actual) : "no value");
}

std::string PositionTables(const Scenario& scenario, const Json& result) {
  TextTable other({"", "ATE rmse [m]", "RPE 1 m [m]", "RPE 20 m [m]", "drift [%]", "tracked"});
  for (const auto& [name, scores] : result["estimators"].items()) {
    other.Add({name, Number(scores, "ate_m.rmse", 3), Number(scores, "rpe_1m.trans_m.mean", 4),
               Number(scores, "rpe_20m.trans_m.mean", 3), Number(scores, "drift_percent", 3),
               Number(scores, "tracked_fraction", 3)});
  }
  return ErrorTable("position error [m]", result, "position_m", "mean", PaperPositions(scenario)) +
         other.Text() + "\n";
}

std::string CompassTable(const Json& result) {
  TextTable table({"", "NEES (1)", "within 3 sigma", "answered"});
  for (const auto& [name, scores] : result["estimators"].items()) {
    table.Add({name, Number(scores, "nees.heading", 2),
               Number(scores, "nees.heading_within_3_sigma", 3),
               Number(scores, "tracked_fraction", 3)});
  }
  return table.Text() + "\n";
}

// Of replays: a run's errors are never aligned.
std::string AlignmentText(const Json& result) {
  if (result["level"] != kReplayLevel || !result["streams"].contains("truth")) return "";
  for (const auto& [name, scores] : result["estimators"].items()) {
    if (!scores.contains("alignment")) continue;
    return fmt::format(", errors after alignment to the truth ({})",
                       scores["alignment"].get<std::string>());
  }
  return ", errors without alignment to the truth";
}

// Without truth: what became of the measurements.
std::string UnscoredTable(const Json& result) {
  TextTable table({"", "used", "unusable", "keyframes", "inliers"});
  for (const auto& [name, run] : result["estimators"].items()) {
    table.Add({name, Number(run, "measurements.used", 0), Number(run, "measurements.unusable", 0),
               Number(run, "measurements.keyframes", 0), Number(run, "measurements.inliers", 0)});
  }
  return table.Text() + "\n";
}

std::string ErrorTables(const Scenario& scenario, const Json& result) {
  if (!result["streams"].contains("truth") && result["level"] == kReplayLevel) {
    return UnscoredTable(result);
  }
  const PaperTable paper = PaperHeadings(scenario);
  return ErrorTable("heading error [deg]", result, "heading_deg",
                    paper.signed_mean ? "mean" : "mean_abs", paper) +
         (AnyPosition(result) ? PositionTables(scenario, result) : CompassTable(result));
}

}  // namespace

std::string FailureLines(const std::vector<CriterionResult>& criteria) {
  std::string text;
  for (const CriterionResult& c : criteria) {
    if (c.verdict == Verdict::kFailed) text += CriterionLine(c);
  }
  return text;
}

std::string RunSummary(const Scenario& scenario, const Json& result,
                       const std::vector<CriterionResult>& criteria) {
  std::string text =
      fmt::format("{}, seed {}{}\n\n", scenario.name, scenario.seed, AlignmentText(result));
  if (!result["estimators"].empty()) text += ErrorTables(scenario, result);
  if (result.contains("polarization_reading_deg")) {
    text += fmt::format(
        "single polarization readings, heading error [deg]: RMSE {}, mean {}, std {}\n\n",
        Number(result, "polarization_reading_deg.rmse", 3),
        Number(result, "polarization_reading_deg.mean", 3),
        Number(result, "polarization_reading_deg.std", 3));
  }
  if (!criteria.empty()) {
    text += "criteria\n";
    for (const CriterionResult& c : criteria) text += CriterionLine(c);
    text += "\n";
  }
  const char* how = result["level"] == kReplayLevel ? "replayed" : "simulated";
  return text + fmt::format("{} s {} in {} s: {} times real time, {} MB\n",
                            Number(result, "sim_duration_s", 1), how, Number(result, "wall_s", 1),
                            Number(result, "real_time_factor", 2),
                            Number(result, "peak_rss_mb", 0));
}

}  // namespace polnav::testbed
