// What did the papers report? Measured with their hardware, under their sky: for comparison beside
// a run's own numbers, which always come from result.json.
#pragma once

#include <array>
#include <string_view>

namespace polnav::testbed {

struct PaperRow {
  std::string_view estimator;  // the name of ours that it is to be compared with
  std::string_view label;
  double max = 0.0;
  double mean = 0.0;  // of the magnitude
  double rmse = 0.0;
  double std = 0.0;
};

// Car on a plaza loop, 5 laps of 377 m [Chu2021, tables of experiment B].
inline constexpr std::string_view kChu2021 = "Chu2021";
inline constexpr std::array<PaperRow, 2> kChu2021Heading_deg{{
    {"stereo", "stereo SLAM", 21.58, 0.54, 1.48, 1.38},
    {"stereo_polarization", "stereo + polarization", 8.11, 0.33, 0.67, 0.58},
}};
inline constexpr std::array<PaperRow, 2> kChu2021Position_m{{
    {"stereo", "stereo SLAM", 5.12, 0.91, 0.99, 0.42},
    {"stereo_polarization", "stereo + polarization", 3.55, 0.83, 0.93, 0.40},
}};

}  // namespace polnav::testbed
