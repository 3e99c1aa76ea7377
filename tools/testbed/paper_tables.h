// What did the papers report? Measured with their hardware, under their sky: for comparison beside
// a run's own numbers, which always come from result.json.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/testbed/scenario.h"

namespace polnav::testbed {

struct PaperRow {
  std::string_view label;
  std::optional<double> max, mean, rmse, std;  // absent: not reported
};

// Rows to show beside ours, the method that the others are compared with first.
struct PaperTable {
  std::string_view paper;
  bool signed_mean = false;  // the paper's mean is of the signed error, else of the magnitude
  std::span<const PaperRow> rows;
};

// Car on a plaza loop, 5 laps of 377 m [Chu2021, tables of experiment B].
inline constexpr std::string_view kChu2021 = "Chu2021";
inline constexpr std::array<PaperRow, 2> kChu2021Heading_deg{{
    {"stereo SLAM", 21.58, 0.54, 1.48, 1.38},
    {"stereo + polarization", 8.11, 0.33, 0.67, 0.58},
}};
inline constexpr std::array<PaperRow, 2> kChu2021Position_m{{
    {"stereo SLAM", 5.12, 0.91, 0.99, 0.42},
    {"stereo + polarization", 3.55, 0.83, 0.93, 0.40},
}};

// Turntable with cars passing [Chu2021, experiment A]. One "angle offset" for the whole turn is all
// it reports.
inline constexpr std::array<PaperRow, 2> kChu2021Turntable_deg{{
    {"stereo SLAM, angle offset", 4.28, {}, {}, {}},
    {"polarization, angle offset", 1.59, {}, {}, {}},
}};

// Pictures of the sky on a turntable [Fan2020, table 1].
inline constexpr std::string_view kFan2020 = "Fan2020";
inline constexpr std::array<PaperRow, 2> kFan2020FewClouds_deg{{
    {"least squares, few clouds", {}, -0.3082, 0.4832, 0.3721},
    {"RANSAC + TLS, few clouds", {}, -0.1680, 0.3625, 0.3212},
}};
inline constexpr std::array<PaperRow, 2> kFan2020ManyClouds_deg{{
    {"least squares, many clouds", {}, -0.1723, 1.3601, 1.3492},
    {"RANSAC + TLS, many clouds", {}, -0.4897, 0.7819, 0.6096},
}};

// A hexapod's simulated walks, about these [Zeng2020, simulation]; headings were 0.2 and 0.05 rad.
inline constexpr std::string_view kZeng2020 = "Zeng2020";
inline constexpr std::array<PaperRow, 2> kZeng2020Heading_deg{{
    {"inertia + flow", {}, {}, 11.5, {}},
    {"inertia + flow + polarization", {}, {}, 2.9, {}},
}};
inline constexpr std::array<PaperRow, 2> kZeng2020Position_m{{
    {"inertia + flow", {}, {}, 0.40, {}},
    {"inertia + flow + polarization", {}, {}, 0.10, {}},
}};

// Of the scenario's paper; no rows where that has none.
[[nodiscard]] PaperTable PaperHeadings(const Scenario& scenario);
[[nodiscard]] PaperTable PaperPositions(const Scenario& scenario);

// One figure of a paper's one run: of the same quantity as a metric of ours.
struct PaperFigure {
  std::string label;
  double value = 0.0;
};

// By metric: heading_deg.rmse, heading_deg.max, position_m.rmse, position_m.max, as far as the
// scenario's paper has them.
[[nodiscard]] std::map<std::string, std::vector<PaperFigure>> PaperFigures(
    const Scenario& scenario);

}  // namespace polnav::testbed
