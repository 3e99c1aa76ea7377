// How is a sky camera calibrated before it is used?
//
// On a level turntable under a clear sky, sun 25 degrees high: 24 pictures of one turn, headings as
// stated by the turntable. The pictures are the simulated camera's own, errors and noise included;
// what they tell is nav/polarization/turn_calibration.h's business, as in `polnav compass
// --calibrate`.
#pragma once

#include <cstdint>
#include <vector>

#include "nav/polarization/turn_calibration.h"
#include "sim/sensors/polarization_camera_options.h"
#include "sky/skylight.h"

namespace polnav::testbed {

// seed, trial: of the instrument.
[[nodiscard]] std::vector<nav::TurnPicture> TakeCalibrationTurn(
    const sim::PolarizationCameraOptions& camera, const sky::SkyOptions& sky, std::uint64_t seed,
    std::uint64_t trial);

}  // namespace polnav::testbed
