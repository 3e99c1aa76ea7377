// Which calibration does a file hold?
//
// JSON, written by `polnav compass --calibrate` and read by `polnav compass --calibration`: the
// fields of nav::PolarizationCameraCalibration with units in their names; angles in degrees.
#pragma once

#include <filesystem>

#include "nav/api/calibration.h"
#include "tools/testbed/result.h"

namespace polnav::testbed {

[[nodiscard]] Json ToJson(const nav::PolarizationCameraCalibration& calibration);

// The pair as ground_truth/cameras.json has it: intrinsics [px], distortion and its model, T_BC.
[[nodiscard]] Json ToJson(const nav::StereoCalibration& calibration);

// Throws InputError on a file that is not there or not such a calibration.
[[nodiscard]] nav::PolarizationCameraCalibration ReadCameraFile(const std::filesystem::path& file);

void WriteCameraFile(const std::filesystem::path& file,
                     const nav::PolarizationCameraCalibration& calibration);

}  // namespace polnav::testbed
