#include "tools/testbed/fault_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "tools/testbed/level_checks.h"
#include "tools/testbed/option_loader.h"

namespace polnav::testbed {
namespace {

std::vector<std::string> SensorsOnBoard(const sim::SensorOptions& sensors, sim::Level level) {
  std::vector<std::string> names;
  if (sensors.stereo) names.emplace_back("stereo");
  if (sensors.stereo && level == sim::Level::kMeasurement) names.emplace_back("stereo_features");
  if (sensors.imu) names.emplace_back("imu");
  if (sensors.polarimeter) names.emplace_back("polarimeter");
  if (sensors.polarization_camera) names.emplace_back("polarization_camera");
  if (sensors.reference) names.emplace_back("reference");
  if (sensors.optical_flow) names.emplace_back("flow");
  return names;
}

void CheckSensor(const YamlDocument& document, const std::string& key, const std::string& sensor,
                 const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), sensor) != known.end()) return;
  if (sensor.empty()) {
    FailAt(document, key,
           fmt::format("a fault needs a sensor, one of: {}", fmt::join(known, ", ")));
  }
  const std::string nearest = NearestWord(sensor, known);
  FailAt(document, key + ".sensor",
         fmt::format("'{}' is not a sensor of this scenario, which are: {}{}", sensor,
                     known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", ")),
                     nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
}

std::vector<std::string> NamesOf(const std::vector<sim::FaultKind>& kinds) {
  std::vector<std::string> names;
  for (const sim::FaultKind kind : kinds) names.emplace_back(sim::NameOf(kind));
  return names;
}

void CheckKind(const YamlDocument& document, const std::string& key,
               const sim::FaultOptions& fault) {
  const std::vector<sim::FaultKind> kinds = sim::KindsGiven(fault);
  if (kinds.empty()) {
    FailAt(document, key,
           fmt::format("a fault needs one of: {}", fmt::join(NamesOf(sim::AllFaultKinds()), ", ")));
  }
  if (kinds.size() > 1) {
    FailAt(document, key,
           fmt::format("'{}' exclude each other: one kind an entry",
                       fmt::join(NamesOf(kinds), "' and '")));
  }
  if (!sim::KindFits(kinds[0], fault.sensor)) {
    FailAt(document, JoinKey(key, sim::NameOf(kinds[0])),
           fmt::format("makes no sense for '{}'", fault.sensor));
  }
}

void CheckAmounts(const YamlDocument& document, const std::string& key,
                  const sim::FaultOptions& fault) {
  const sim::Amounts* const amounts = sim::AmountsOf(fault);
  if (amounts == nullptr) return;
  const std::string section = JoinKey(key, sim::NameOf(sim::KindsGiven(fault)[0]));
  const std::vector<std::string> given = sim::AmountsGiven(*amounts);
  for (const std::string& amount : given) {
    if (sim::AmountFits(amount, fault.sensor)) continue;
    FailAt(document, JoinKey(section, amount), fmt::format("'{}' has none", fault.sensor));
  }
  const bool any = std::any_of(given.begin(), given.end(), [](const std::string& amount) {
    return amount != "channel" && amount != "side";
  });
  if (fault.noise && fault.noise->times) {
    if (fault.sensor != "imu" && fault.sensor != "polarization_camera") {
      FailAt(document, section + ".times",
             fmt::format("the rig does not state the noise of '{}'; give one sigma instead",
                         fault.sensor));
    }
    if (!given.empty()) FailAt(document, section, "either times or sigmas, not both");
  } else if (!any) {
    FailAt(document, section,
           fmt::format("does nothing: no amount for '{}' is given", fault.sensor));
  }
}

void CheckParts(const YamlDocument& document, const std::string& key,
                const sim::FaultOptions& fault) {
  const bool mosaic = fault.sensor == "polarization_camera";
  const sim::Amounts* const amounts = sim::AmountsOf(fault);
  if (mosaic && amounts != nullptr && amounts->channel > 3) {
    FailAt(document, fmt::format("{}.{}.channel", key, sim::NameOf(sim::KindsGiven(fault)[0])),
           fmt::format("{} is out of range, a mosaic has channels 0 to 3", amounts->channel));
  }
  if (mosaic && fault.dead_channel && fault.dead_channel->channel > 3) {
    FailAt(document, key + ".dead_channel.channel",
           fmt::format("{} is out of range, a mosaic has channels 0 to 3",
                       fault.dead_channel->channel));
  }
  if (!fault.corrupt || !mosaic) return;
  if (fault.corrupt->side != "both") {
    FailAt(document, key + ".corrupt.side", fmt::format("'{}' has no sides", fault.sensor));
  }
  if (fault.corrupt->look == "missing") {
    FailAt(document, key + ".corrupt.look", "'missing' is for one of a pair; use drop or off");
  }
}

void CheckEnd(const YamlDocument& document, const std::string& key, const Scenario& scenario,
              const sim::FaultOptions& fault) {
  if (fault.start_s < scenario.duration_s) return;
  // --duration cuts a run short on purpose: the file's own faults after that are left out, not
  // wrong. Faults from the command line were meant for this very run.
  const auto set_here = [](const auto& entry) { return entry.first.starts_with("faults"); };
  const bool own = std::none_of(document.overrides.begin(), document.overrides.end(), set_here);
  if (own && document.overrides.contains("duration_s")) return;
  FailAt(document, key + ".start_s",
         fmt::format("{} s is after the end; the scenario lasts {} s", fault.start_s,
                     scenario.duration_s));
}

void CheckOverlaps(const YamlDocument& document, const std::vector<sim::FaultOptions>& faults) {
  for (std::size_t b = 1; b < faults.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if (faults[a].sensor != faults[b].sensor) continue;
      if (!sim::OverlapInTime(faults[a], faults[b])) continue;
      if (!sim::ExcludeEachOther(faults[a], faults[b])) continue;
      FailAt(document, fmt::format("faults.{}", b),
             fmt::format("'{}' of '{}' overlaps in time with '{}' in faults.{}, and they exclude "
                         "each other",
                         sim::NameOf(sim::KindsGiven(faults[b])[0]), faults[b].sensor,
                         sim::NameOf(sim::KindsGiven(faults[a])[0]), a));
    }
  }
}

}  // namespace

void CheckFaults(const YamlDocument& document, const Scenario& scenario, sim::Level level) {
  const std::vector<std::string> known = SensorsOnBoard(scenario.sensors, level);
  for (std::size_t i = 0; i < scenario.faults.size(); ++i) {
    const sim::FaultOptions& fault = scenario.faults[i];
    const std::string key = fmt::format("faults.{}", i);
    CheckSensor(document, key, fault.sensor, known);
    CheckKind(document, key, fault);
    CheckAmounts(document, key, fault);
    CheckParts(document, key, fault);
    CheckEnd(document, key, scenario, fault);
  }
  CheckOverlaps(document, FaultsAt(level, scenario.faults));
}

}  // namespace polnav::testbed
