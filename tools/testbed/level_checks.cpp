#include "tools/testbed/level_checks.h"

#include <fmt/format.h>

#include <utility>

namespace polnav::testbed {
namespace {

constexpr const char* kFeatures = "stereo_features";

void CheckCamera(const YamlDocument& document, const sim::StereoCameraOptions& stereo) {
  if (stereo.ground_truth) {
    FailAt(document, "sensors.stereo.ground_truth",
           "depth and flow belong to pictures, and --level measurement draws none");
  }
  if (stereo.rolling_shutter_s > 0.0) {
    FailAt(document, "sensors.stereo.rolling_shutter_s",
           "--level measurement sees all rows at one instant: 0, or --level image");
  }
}

void CheckFault(const YamlDocument& document, const std::string& key,
                const sim::FaultOptions& fault) {
  if (fault.sensor != "stereo") return;
  const char* const kind = sim::NameOf(sim::KindsGiven(fault)[0]);
  if (fault.corrupt) {
    FailAt(document, JoinKey(key, kind), "acts on pictures, and --level measurement draws none");
  }
  if (sim::AmountsOf(fault) != nullptr) {
    FailAt(document, JoinKey(key, kind),
           fmt::format("changes grey levels, and --level measurement draws no pictures; give "
                       "feature_px to sensor '{}' instead",
                       kFeatures));
  }
}

}  // namespace

void CheckLevel(const YamlDocument& document, const Scenario& scenario, sim::Level level) {
  if (level != sim::Level::kMeasurement) return;
  if (scenario.sensors.stereo) CheckCamera(document, *scenario.sensors.stereo);
  for (std::size_t i = 0; i < scenario.faults.size(); ++i) {
    CheckFault(document, fmt::format("faults.{}", i), scenario.faults[i]);
  }
}

std::vector<sim::FaultOptions> FaultsAt(sim::Level level, std::vector<sim::FaultOptions> faults) {
  if (level != sim::Level::kMeasurement) return faults;
  for (sim::FaultOptions& fault : faults) {
    if (fault.sensor == "stereo") fault.sensor = kFeatures;
  }
  return faults;
}

}  // namespace polnav::testbed
