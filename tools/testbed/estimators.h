// Which estimators can a scenario run, and what must the vehicle carry for them?
#pragma once

#include <array>
#include <string_view>

namespace polnav::testbed {

struct EstimatorInfo {
  std::string_view name;
  std::string_view description;
  bool needs_stereo = false;
  bool needs_polarimeter = false;
};

inline constexpr std::array<EstimatorInfo, 2> kEstimators{{
    {.name = "stereo",
     .description = "stereo visual odometry in a sliding window, without the sky",
     .needs_stereo = true,
     .needs_polarimeter = false},
    {.name = "stereo_polarization",
     .description = "stereo and polarized skylight, tightly coupled [Chu2021]",
     .needs_stereo = true,
     .needs_polarimeter = true},
}};

}  // namespace polnav::testbed
