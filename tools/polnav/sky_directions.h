// Which directions of the sky does a CSV file name, and what does the sky say of them?
//
// Read: azimuth_deg,elevation_deg, with or without that header; '#' starts a comment. Written:
// azimuth_deg,elevation_deg,I,Q,U,dop,aop_deg. I is relative to the zenith; Q, U and the angle are
// about axis 1, in the vertical plane pointing away from the zenith, towards axis 2, the way that
// azimuth grows (sky/ray_axes.h).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sky/clear_sky.h"

namespace polnav::testbed {

struct SkyDirection {
  double azimuth_deg = 0.0;    // compass
  double elevation_deg = 0.0;  // 0 to 90
};

// Throws InputError that names the file and the line.
[[nodiscard]] std::vector<SkyDirection> ReadDirections(const std::filesystem::path& file);

// Every 5 degrees of azimuth and 2.5 of elevation, the zenith once.
[[nodiscard]] std::vector<SkyDirection> WholeSky();

[[nodiscard]] std::string SkyCsv(const sky::ClearSky& sky,
                                 const std::vector<SkyDirection>& directions);

}  // namespace polnav::testbed
