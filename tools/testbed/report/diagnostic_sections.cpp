// The estimators' insides: what vision used and what not, consistency, the sky's residuals.
#include <fmt/format.h>

#include <algorithm>

#include "tools/testbed/report/sections.h"

namespace polnav::testbed {
namespace {

bool FollowsFeatures(const EstimatorRun& run) { return !run.diagnostics.frames.empty(); }

std::string PointTable(const std::vector<EstimatorRun>& runs) {
  HtmlTable table{
      .rows = {{"", "offered", "inliers", "against the flow", "outliers of the pose",
                "out of the map", "frames against the IMU", "frames against the pictures",
                "sky readings gated", "places recognized", "failed solves"}}};
  for (const EstimatorRun& run : runs) {
    if (!FollowsFeatures(run)) continue;
    const OutcomeCounts& c = run.counts;
    std::vector<std::string> row = {run.name};
    for (const std::uint64_t n :
         {c.features, c.inliers, c.flow_rejected, c.pose_rejected, c.map_rejected, c.imu_wrong,
          c.pictures_wrong, c.gated_readings, c.returns, c.failed_solves}) {
      row.push_back(std::to_string(n));
    }
    table.rows.push_back(row);
  }
  return "<section><h2>What became of the points</h2>" + table.Html() + "</section>";
}

std::string NeesCharts(const ReportInput& input) {
  const bool aligned =
      std::any_of(input.record.estimators.begin(), input.record.estimators.end(),
                  [](const EstimatorRun& run) { return run.alignment != Alignment::kNone; });
  if (input.record.truth.empty() || aligned) return "";
  std::string html =
      ChartCard("nees-heading", "NEES of heading",
                "Squared error over its claimed variance. Honest: 1 on average, below "
                "the dashed line 95 % of the time.");
  if (HasPositions(input)) {
    html += ChartCard("nees-position", "NEES of position",
                      "Three-dimensional. Honest: 3 on average, below the dashed line 95 % of the "
                      "time.");
  }
  return html;
}

std::string OwnCharts(const EstimatorRun& run, std::size_t index) {
  const std::string name = EscapeMarkup(run.name);
  std::string html =
      ChartCard(fmt::format("rejected-{}", index), name + ": points rejected",
                "A frame: against the predicted flow, outliers of the pose, taken out of "
                "the map by the bundle adjustment.");
  html += ChartCard(fmt::format("window-{}", index), name + ": window",
                    "Landmarks (left axis) and keyframes (right axis) of the map.");
  if (!run.diagnostics.sky.empty()) {
    html += ChartCard(fmt::format("sky-{}", index), name + ": residuals of the sky",
                      "Heading of each reading less the one expected, used or gated; shaded: three "
                      "sigma.");
  }
  return html;
}

}  // namespace

std::string DiagnosticSections(const ReportInput& input) {
  const std::vector<EstimatorRun>& runs = input.record.estimators;
  std::string html = NeesCharts(input);
  if (std::any_of(runs.begin(), runs.end(), FollowsFeatures)) {
    html += ChartCard("features", "Points followed",
                      "Offered by the front end, and those that each pose rests on (inliers).");
    html += ChartCard(
        "vision-nis", "NIS of vision",
        "Chi square of the inliers over its degrees of freedom: 1 when pixels are as noisy "
        "as believed.");
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (FollowsFeatures(runs[i])) html += OwnCharts(runs[i], i);
  }
  if (html.empty()) return "";
  html = "<div class=\"columns\">" + html + "</div>";
  return std::any_of(runs.begin(), runs.end(), FollowsFeatures) ? PointTable(runs) + html : html;
}

}  // namespace polnav::testbed
