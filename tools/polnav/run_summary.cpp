#include "tools/polnav/run_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "tools/polnav/console.h"
#include "tools/testbed/metrics.h"
#include "tools/testbed/paper_tables.h"

namespace polnav::testbed {
namespace {

std::string Number(const Json& tree, const std::string& path, int digits) {
  const std::optional<double> value = MetricAt(tree, path);
  return value ? fmt::format("{:.{}f}", *value, digits) : "-";
}

std::string Fixed(double value) { return fmt::format("{:.2f}", value); }

// mean: the path of the mean magnitude, which papers call the mean error.
void AddErrorRows(TextTable& table, const Json& result, const std::string& errors,
                  const std::string& mean, std::span<const PaperRow> paper) {
  for (const auto& [name, scores] : result["estimators"].items()) {
    table.Add({name, Number(scores, errors + ".max", 3), Number(scores, errors + "." + mean, 3),
               Number(scores, errors + ".rmse", 3), Number(scores, errors + ".std", 3)});
  }
  for (const PaperRow& row : paper) {
    table.Add({fmt::format("  {}: {}", kChu2021, row.label), Fixed(row.max), Fixed(row.mean),
               Fixed(row.rmse), Fixed(row.std)});
  }
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

std::string ErrorTables(const Scenario& scenario, const Json& result) {
  const bool chu =
      std::find(scenario.paper.begin(), scenario.paper.end(), kChu2021) != scenario.paper.end();
  std::span<const PaperRow> paper_heading;
  std::span<const PaperRow> paper_position;
  if (chu) {
    paper_heading = kChu2021Heading_deg;
    paper_position = kChu2021Position_m;
  }
  TextTable heading({"heading error [deg]", "max", "mean", "RMSE", "std"});
  AddErrorRows(heading, result, "heading_deg", "mean_abs", paper_heading);
  TextTable position({"position error [m]", "max", "mean", "RMSE", "std"});
  AddErrorRows(position, result, "position_m", "mean", paper_position);
  TextTable other({"", "ATE rmse [m]", "RPE 1 m [m]", "drift [%]", "tracked"});
  for (const auto& [name, scores] : result["estimators"].items()) {
    other.Add({name, Number(scores, "ate_m.rmse", 3), Number(scores, "rpe_1m.trans_m.mean", 4),
               Number(scores, "drift_percent", 3), Number(scores, "tracked_fraction", 3)});
  }
  return heading.Text() + "\n" + position.Text() + "\n" + other.Text() + "\n";
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
  std::string text = fmt::format("{}, seed {}\n\n", scenario.name, scenario.seed);
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
  return text + fmt::format("{} s simulated in {} s: {} times real time, {} MB\n",
                            Number(result, "sim_duration_s", 1), Number(result, "wall_s", 1),
                            Number(result, "real_time_factor", 2),
                            Number(result, "peak_rss_mb", 0));
}

}  // namespace polnav::testbed
