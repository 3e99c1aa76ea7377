// What does the sky look like, drawn?
//
// Three panels, as on a map with north up and east right, zenith in the middle and the horizon
// around: angle and degree of polarization, and radiance, each with its bar; the sun and the
// neutral points above the horizon are marked.
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "sky/clear_sky.h"

namespace polnav::testbed {

// 8 bits, BGR.
[[nodiscard]] cv::Mat DrawSky(const sky::ClearSky& sky, const std::string& title,
                              const std::string& subtitle);

}  // namespace polnav::testbed
