// How is a sensor's calibration written into EuRoC's sensor.yaml, and read back to the same bits?
//
// EuRoC's own keys where it has them (T_BS, rate_hz, resolution, camera_model, intrinsics,
// distortion_model, distortion_coefficients, gyroscope_noise_density ...), Polnav's beside them
// for the rest; docs/datasets.md lists them all. S is the sensor, B the body. Numbers are written
// with as many digits as they need to come back unchanged.
#pragma once

#include <string>
#include <vector>

#include "nav/api/calibration.h"
#include "sim/simulator.h"
#include "tools/testbed/dataset/sensor_section.h"
#include "tools/testbed/option_tree.h"

namespace polnav::testbed {

struct SensorYaml {
  std::string folder;  // below mav0
  Json yaml;
};

// One for each sensor on board. sensors: their rates.
[[nodiscard]] std::vector<SensorYaml> SensorYamls(const nav::Rig& rig,
                                                  const sim::SensorOptions& sensors);

// Throw InputError for what is missing or cannot be (no focal length, T_BS that is no rotation).
[[nodiscard]] nav::CameraCalibration CameraFrom(const SensorSection& section);
[[nodiscard]] nav::ImuCalibration ImuFrom(const SensorSection& section);
[[nodiscard]] nav::PolarimeterCalibration PolarimeterFrom(const SensorSection& section);
[[nodiscard]] nav::PolarizationCameraCalibration PolarizationCameraFrom(
    const SensorSection& section);
[[nodiscard]] nav::OpticalFlowCalibration OpticalFlowFrom(const SensorSection& section);

// The second camera is to the right of the first, both have pictures of one size.
void CheckPair(const nav::StereoCalibration& stereo, const SensorSection& right);

}  // namespace polnav::testbed
