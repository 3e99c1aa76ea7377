// The numbers: errors beside the paper's, consistency, criteria.
#include <fmt/format.h>

#include <algorithm>

#include "tools/testbed/metrics.h"
#include "tools/testbed/paper_tables.h"
#include "tools/testbed/report/sections.h"

namespace polnav::testbed {
namespace {

std::string Number(const Json& tree, const std::string& path, int digits) {
  const std::optional<double> value = MetricAt(tree, path);
  return value ? fmt::format("{:.{}f}", *value, digits) : "–";
}

// How much smaller (-) or larger (+) than the first row of the same origin.
std::string Change(std::optional<double> value, std::optional<double> base) {
  if (!value || !base || *base <= 0.0) return "–";
  return fmt::format("{:+.1f} %", 100.0 * (*value / *base - 1.0));
}

std::string ErrorTable(const Json& result, const std::string& errors, const std::string& mean,
                       const PaperTable& paper) {
  HtmlTable table{.rows = {{"", "max", "mean", "RMSE", "std", "RMSE change"}}};
  std::optional<double> base;
  bool first = true;
  for (const auto& [name, scores] : result["estimators"].items()) {
    const std::optional<double> rmse = MetricAt(scores, errors + ".rmse");
    if (first) base = rmse;
    table.rows.push_back({name, Number(scores, errors + ".max", 3),
                          Number(scores, errors + "." + mean, 3),
                          Number(scores, errors + ".rmse", 3), Number(scores, errors + ".std", 3),
                          first ? "" : Change(rmse, base)});
    table.row_class.emplace_back("");
    first = false;
  }
  for (const PaperRow& row : paper.rows) {
    const auto fixed = [](std::optional<double> v) {
      return v ? fmt::format("{:.2f}", *v) : std::string("–");
    };
    const bool is_base = row.label == paper.rows.front().label;
    table.rows.push_back({fmt::format("{}: {}", paper.paper, row.label), fixed(row.max),
                          fixed(row.mean), fixed(row.rmse), fixed(row.std),
                          is_base ? "" : Change(row.rmse, paper.rows.front().rmse)});
    table.row_class.emplace_back("paper");
  }
  return table.Html();
}

std::string DetailTable(const Json& result) {
  HtmlTable table{.rows = {{"", "ATE rmse [m]", "RPE 1 m [m]", "RPE 1 m [°]", "RPE 20 m [m]",
                            "RPE 100 m [m]", "drift [%]", "NEES position (3)", "NEES heading (1)",
                            "within 3σ", "tracked", "keyframes"}}};
  for (const auto& [name, s] : result["estimators"].items()) {
    table.rows.push_back({name, Number(s, "ate_m.rmse", 3), Number(s, "rpe_1m.trans_m.mean", 4),
                          Number(s, "rpe_1m.rot_deg.mean", 4), Number(s, "rpe_20m.trans_m.mean", 3),
                          Number(s, "rpe_100m.trans_m.mean", 3), Number(s, "drift_percent", 3),
                          Number(s, "nees.position", 2), Number(s, "nees.heading", 2),
                          Number(s, "nees.heading_within_3_sigma", 3),
                          Number(s, "tracked_fraction", 3),
                          Number(s, "measurements.keyframes", 0)});
  }
  return table.Html();
}

std::string ConsistencyTable(const Json& result) {
  HtmlTable table{.rows = {{"", "NEES heading (1)", "within 3σ", "answered"}}};
  for (const auto& [name, s] : result["estimators"].items()) {
    table.rows.push_back({name, Number(s, "nees.heading", 2),
                          Number(s, "nees.heading_within_3_sigma", 3),
                          Number(s, "tracked_fraction", 3)});
  }
  return table.Html();
}

std::string PositionNote(const RunRecord& record) {
  const std::string alignment = AlignmentText(record);
  return alignment == "not aligned" ? "Without any alignment: where the estimator believed to be."
                                    : "Estimates " + alignment + ".";
}

}  // namespace

std::string AlignmentText(const RunRecord& record) {
  for (const EstimatorRun& run : record.estimators) {
    if (run.alignment == Alignment::kNone) continue;
    return fmt::format("aligned to the truth ({})", NameOf(run.alignment));
  }
  return "not aligned";
}

std::string ErrorSections(const ReportInput& input) {
  if (input.result["estimators"].empty()) return "";
  if (input.record.truth.empty()) {
    return "<section><h2>Errors</h2><p class=\"soft\">The dataset has no truth: nothing to score."
           "</p></section>";
  }
  const PaperTable paper = PaperHeadings(input.scenario);
  std::string note =
      paper.signed_mean ? "Mean is of the signed error; " : "Mean is of the magnitude; ";
  note += "change is against the first row.";
  if (!paper.rows.empty()) {
    note +=
        " Rows in italics are the paper's, measured with its hardware; all others come from "
        "this run.";
  }
  std::string html =
      "<div class=\"columns\"><section><h2>Heading error [°]</h2>" +
      ErrorTable(input.result, "heading_deg", paper.signed_mean ? "mean" : "mean_abs", paper) +
      "<p class=\"soft small\">" + note + "</p></section>";
  if (HasPositions(input)) {
    html +=
        "<section><h2>Position error [m]</h2>" +
        ErrorTable(input.result, "position_m", "mean", PaperPositions(input.scenario)) +
        "<p class=\"soft small\">" + PositionNote(input.record) +
        "</p>"
        "</section></div><section><h2>Trajectory and consistency</h2>" +
        DetailTable(input.result) +
        "<p class=\"soft small\">ATE after SE(3) alignment; RPE: mean over consecutive pairs by "
        "distance travelled (evo's definitions). NEES in brackets: what an honest covariance "
        "gives.</p></section>";
    return html;
  }
  return html + "<section><h2>Consistency</h2>" + ConsistencyTable(input.result) +
         "<p class=\"soft small\">NEES in brackets: what an honest sigma gives. Answered: share of "
         "the pictures in which a heading was found.</p></section></div>";
}

std::string CriteriaSection(const ReportInput& input) {
  if (input.criteria.empty()) return "";
  std::string rows;
  for (const CriterionResult& c : input.criteria) {
    const char* verdict = c.verdict == Verdict::kPassed   ? "pass"
                          : c.verdict == Verdict::kFailed ? "fail"
                                                          : "skip";
    rows += fmt::format(
        "<tr><td class=\"text\">{}</td><td class=\"text\"><code>{}</code></td><td>{}</td>"
        "<td class=\"{}\"><b>{}</b></td></tr>",
        EscapeMarkup(c.name), EscapeMarkup(c.expected),
        c.actual ? fmt::format("{:.6g}", *c.actual) : "–", verdict, verdict);
  }
  return "<section><h2>Criteria</h2><div class=\"scroll\"><table><thead><tr><th>criterion</th>"
         "<th class=\"text\">expected</th><th>actual</th><th>verdict</th></tr></thead><tbody>" +
         rows + "</tbody></table></div></section>";
}

}  // namespace polnav::testbed
