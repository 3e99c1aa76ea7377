#include "tools/testbed/dataset/rig_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "tools/testbed/option_loader.h"

namespace polnav::testbed {
namespace {

const std::vector<std::string>& Known() {
  static const std::vector<std::string> names{"cam0", "cam1", "imu0", "pol0", "polcam0", "flow0"};
  return names;
}

}  // namespace

std::optional<RigFile> ReadRigFile(const std::filesystem::path& file) {
  if (file.empty()) return std::nullopt;
  RigFile rig = ReadYaml(file);
  if (!rig.root.IsMap()) FailAt(rig, "", "expected sections: cam0: {...}");
  for (const auto& entry : rig.root) {
    const std::string sensor = entry.first.IsScalar() ? entry.first.Scalar() : "?";
    if (std::find(Known().begin(), Known().end(), sensor) != Known().end()) continue;
    const std::string nearest = NearestWord(sensor, Known());
    FailAt(rig, sensor,
           fmt::format("is not one of: {}{}", fmt::join(Known(), ", "),
                       nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
  }
  return rig;
}

bool HasSection(const std::optional<RigFile>& rig, const std::string& sensor) {
  if (!rig) return false;
  const YAML::Node& root = rig->root;
  return root[sensor].IsDefined();
}

SensorSection SectionOf(const std::optional<RigFile>& rig, const std::string& sensor,
                        const std::filesystem::path& sensor_yaml) {
  return HasSection(rig, sensor) ? SensorSection(*rig, sensor)
                                 : SensorSection(ReadYaml(sensor_yaml), "");
}

}  // namespace polnav::testbed
