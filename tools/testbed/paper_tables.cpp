#include "tools/testbed/paper_tables.h"

#include <algorithm>

namespace polnav::testbed {
namespace {

bool Cites(const Scenario& scenario, std::string_view paper) {
  return std::find(scenario.paper.begin(), scenario.paper.end(), paper) != scenario.paper.end();
}

void AddFigures(const PaperTable& table, const std::string& quantity,
                std::map<std::string, std::vector<PaperFigure>>& figures) {
  for (const PaperRow& row : table.rows) {
    const std::string label = std::string(table.paper) + ": " + std::string(row.label);
    if (row.rmse) figures[quantity + ".rmse"].push_back({label, *row.rmse});
    if (row.max) figures[quantity + ".max"].push_back({label, *row.max});
  }
}

}  // namespace

PaperTable PaperHeadings(const Scenario& scenario) {
  if (Cites(scenario, kChu2021)) {
    if (scenario.vehicle.turntable) return {.paper = kChu2021, .rows = kChu2021Turntable_deg};
    return {.paper = kChu2021, .rows = kChu2021Heading_deg};
  }
  if (Cites(scenario, kFan2020)) {
    const bool many = scenario.sky.clouds == "many_clouds";
    return {.paper = kFan2020,
            .signed_mean = true,
            .rows = many ? kFan2020ManyClouds_deg : kFan2020FewClouds_deg};
  }
  if (Cites(scenario, kZeng2020)) return {.paper = kZeng2020, .rows = kZeng2020Heading_deg};
  return {};
}

PaperTable PaperPositions(const Scenario& scenario) {
  if (Cites(scenario, kChu2021) && !scenario.vehicle.turntable) {
    return {.paper = kChu2021, .rows = kChu2021Position_m};
  }
  if (Cites(scenario, kZeng2020)) return {.paper = kZeng2020, .rows = kZeng2020Position_m};
  return {};
}

std::map<std::string, std::vector<PaperFigure>> PaperFigures(const Scenario& scenario) {
  std::map<std::string, std::vector<PaperFigure>> figures;
  AddFigures(PaperHeadings(scenario), "heading_deg", figures);
  AddFigures(PaperPositions(scenario), "position_m", figures);
  return figures;
}

}  // namespace polnav::testbed
