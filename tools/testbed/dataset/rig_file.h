// Which calibrations does the user put in the place of the dataset's?
//
// One YAML file: a section a sensor (cam0, cam1, imu0, pol0, polcam0, flow0), each with the keys
// that its sensor.yaml would have.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "tools/testbed/dataset/sensor_section.h"
#include "tools/testbed/yaml_document.h"

namespace polnav::testbed {

using RigFile = YamlDocument;

// Nothing when the path is empty. Throws InputError: no such file, a section that is no sensor.
[[nodiscard]] std::optional<RigFile> ReadRigFile(const std::filesystem::path& file);

// What the rig file says of this sensor, or else the sensor's own file.
[[nodiscard]] SensorSection SectionOf(const std::optional<RigFile>& rig, const std::string& sensor,
                                      const std::filesystem::path& sensor_yaml);

[[nodiscard]] bool HasSection(const std::optional<RigFile>& rig, const std::string& sensor);

}  // namespace polnav::testbed
