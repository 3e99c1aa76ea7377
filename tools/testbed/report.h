// What would a person want to see of a run?
//
// One HTML file that needs nothing else: charts, tables beside the paper's, pictures, timing,
// hashes, criteria, and everything needed to run it again. Chart.js is inside; no network.
// Series are thinned to at most 2000 points, each block by its extremes, so that peaks stay.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/testbed/option_tree.h"
#include "tools/testbed/result.h"
#include "tools/testbed/run_record.h"
#include "tools/testbed/scenario.h"

namespace polnav::testbed {

struct ReportInput {
  const Scenario& scenario;
  const RunRecord& record;
  const Json& result;
  const std::vector<CriterionResult>& criteria;
  std::string command_line;
};

[[nodiscard]] std::string HtmlReport(const ReportInput& input);

// Indices to draw, in order, of a series thinned to at most max_points: first, last, and of each
// block the smallest and the largest value.
[[nodiscard]] std::vector<std::size_t> Thin(const std::vector<double>& values,
                                            std::size_t max_points = 2000);

// "Polnav 0.1.0", and what it was built with.
[[nodiscard]] std::string VersionText();

}  // namespace polnav::testbed
