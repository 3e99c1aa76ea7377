// What did the compass see, and where did it look?
//
// Three panels, a square a block: angle of polarization as hue, about the image's rows (red) and
// clockwise; degree of polarization as grey, white at 0.6; weight as green, blocks left out as
// dark red. A line through the optical axis is the solar meridian that was found.
#pragma once

#include <opencv2/core/mat.hpp>

#include "nav/polarization/compass.h"

namespace polnav::testbed {

[[nodiscard]] cv::Mat CompassPicture(const nav::CompassTrace& trace,
                                     const nav::CompassReading& reading,
                                     const nav::PolarizationCameraCalibration& calibration);

}  // namespace polnav::testbed
