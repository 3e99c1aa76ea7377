#include "tools/testbed/dataset/replay_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "tools/testbed/estimators.h"
#include "tools/testbed/input_error.h"
#include "tools/testbed/option_loader.h"
#include "tools/testbed/option_tree.h"

namespace polnav::testbed {
namespace {

constexpr std::array<const char*, 8> kSettable{"name", "description", "paper",      "seed",
                                               "site", "faults",      "estimators", "criteria"};

YamlDocument DocumentOf(const DatasetInfo& info) {
  if (!info.scenario_file.empty()) return ReadYaml(info.scenario_file);
  const Json defaults = {{"name", info.name.empty() ? info.format : info.name},
                         {"estimators", {{"run", DefaultEstimators(info.rig)}}}};
  return ParseYaml(ToYaml(defaults), "a dataset without scenario.yaml");
}

// What is on board is what the dataset has; options stay for the record.
template <typename Sensor>
void Equip(bool present, std::optional<Sensor>& sensor) {
  if (!present) {
    sensor.reset();
  } else if (!sensor) {
    sensor.emplace();
  }
}

void CheckSettable(const ScenarioOverride& change) {
  const std::string first = change.assignment.substr(0, change.assignment.find_first_of(".="));
  if (std::find(kSettable.begin(), kSettable.end(), first) != kSettable.end()) return;
  throw InputError(
      change.source, 0, "",
      fmt::format("a replay does not simulate; it can change: {}", fmt::join(kSettable, ", ")));
}

}  // namespace

std::vector<std::string> DefaultEstimators(const nav::Rig& rig) {
  if (rig.stereo && rig.polarimeter) return {"stereo", "stereo_polarization"};
  if (rig.stereo) return {"stereo"};
  if (rig.imu && rig.optical_flow) {
    if (rig.polarimeter) return {"ukf_no_polarization", "ukf"};
    return {"ukf_no_polarization"};
  }
  if (rig.polarization_camera) return {"compass_stokes"};
  if (rig.polarimeter) return {"polarization"};
  return {};
}

bool NeedsSun(const Scenario& scenario) {
  const auto& run = scenario.estimators.run;
  return std::any_of(run.begin(), run.end(), [](const std::string& name) {
    const EstimatorInfo& info = InfoOf(name);
    return info.needs_polarimeter || info.needs_polarization_camera;
  });
}

Scenario ReplaySettings(const DatasetInfo& info, const std::vector<ScenarioOverride>& overrides) {
  YamlDocument document = DocumentOf(info);
  for (const ScenarioOverride& change : overrides) {
    CheckSettable(change);
    ApplyOverride(document, change.assignment, change.source);
  }
  // The recording may have been cut short: the file's own faults after its end are left out, as
  // they were live.
  document.overrides.emplace("duration_s", "the recording");
  Scenario scenario;
  LoadOptions(document, scenario);
  if (info.scenario_file.empty()) scenario.duration_s = nav::ToSeconds(info.duration);
  if (scenario.name.empty()) FailAt(document, "name", "a scenario needs a name");
  Equip(info.rig.stereo.has_value(), scenario.sensors.stereo);
  Equip(info.rig.imu.has_value(), scenario.sensors.imu);
  Equip(info.rig.polarimeter.has_value(), scenario.sensors.polarimeter);
  Equip(info.rig.polarization_camera.has_value(), scenario.sensors.polarization_camera);
  Equip(info.rig.optical_flow.has_value(), scenario.sensors.optical_flow);
  Equip(info.has_reference, scenario.sensors.reference);
  CheckListening(document, scenario);
  return scenario;
}

}  // namespace polnav::testbed
