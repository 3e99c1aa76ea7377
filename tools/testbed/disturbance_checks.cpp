#include "tools/testbed/disturbance_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <string>
#include <vector>

#include "sim/disturbances/on_the_road.h"

namespace polnav::testbed {
namespace {

using sim::DisturbanceOptions;

// The kinds that an entry has; right is exactly one.
std::vector<std::string> KindsOf(const DisturbanceOptions& entry) {
  std::vector<std::string> kinds;
  const auto add = [&](const char* name, const auto& kind) {
    if (kind) kinds.emplace_back(name);
  };
  add("passing", entry.passing);
  add("darkness", entry.darkness);
  add("overexposure", entry.overexposure);
  add("glare", entry.glare);
  add("fog", entry.fog);
  add("rain", entry.rain);
  add("dirt", entry.dirt);
  add("cloud_passage", entry.cloud_passage);
  add("low_features", entry.low_features);
  add("canopy", entry.canopy);
  add("tunnel", entry.tunnel);
  add("bridge", entry.bridge);
  return kinds;
}

// A stretch is there from the beginning to the end: times would be ignored without a word.
void CheckTimeless(const YamlDocument& document, const std::string& key, std::size_t index) {
  const YAML::Node entry = document.root["disturbances"][index];
  for (const char* time : {"start_s", "duration_s", "mean_interval_s"}) {
    if (entry[time]) {
      FailAt(document, JoinKey(key, time), "a stretch of road is there all the time: it has none");
    }
  }
}

// Can it stand on the road, with whatever stands there already?
void CheckStretch(const YamlDocument& document, const std::string& key, double lap_m,
                  const sim::StructureOptions& stretch,
                  std::vector<sim::StructureOptions>& standing) {
  standing.push_back(stretch);
  const auto fault = sim::FindFault(standing, lap_m);
  if (fault) FailAt(document, JoinKey(key, fault->key), fault->message);
}

void CheckPassing(const YamlDocument& document, const Scenario& scenario, const std::string& key,
                  const sim::PassingOptions& passing) {
  constexpr double kLeast_m_s = 0.2;  // of difference: less takes minutes to pass
  const double own_m_s = sim::PlaceOf(scenario.vehicle)
                             ? 0.0
                             : scenario.vehicle.car.value_or(sim::CarOptions{}).speed_m_s;
  if (std::abs(passing.speed_m_s - own_m_s) >= kLeast_m_s) return;
  FailAt(
      document, key + ".passing.speed_m_s",
      fmt::format("{} m/s never passes a vehicle that drives {} m/s", passing.speed_m_s, own_m_s));
}

void CheckTimes(const YamlDocument& document, const Scenario& scenario, const std::string& key,
                const DisturbanceOptions& entry) {
  // --duration cuts a run short on purpose: what would have come later does not come.
  if (entry.start_s < scenario.duration_s || document.overrides.contains("duration_s")) return;
  FailAt(document, JoinKey(key, "start_s"),
         fmt::format("{} s is after the end of the scenario, at {} s", entry.start_s,
                     scenario.duration_s));
}

void CheckDisturbance(const YamlDocument& document, const Scenario& scenario, std::size_t index,
                      std::vector<sim::StructureOptions>& standing) {
  const DisturbanceOptions& entry = scenario.disturbances[index];
  const std::string key = fmt::format("disturbances.{}", index);
  const std::vector<std::string> kinds = KindsOf(entry);
  if (kinds.size() != 1) {
    FailAt(document, key,
           kinds.empty() ? "a disturbance needs one kind, such as passing, fog or tunnel"
                         : fmt::format("a disturbance has one kind, not {}: {}", kinds.size(),
                                       fmt::join(kinds, ", ")));
  }
  CheckTimes(document, scenario, key, entry);
  if (entry.cloud_passage && !(scenario.sky.wind_m_s > 0.0)) {
    FailAt(document, JoinKey(key, "cloud_passage"), "no cloud passes: sky.wind_m_s is 0");
  }
  if (entry.passing) CheckPassing(document, scenario, key, *entry.passing);
  if (const auto stretch = sim::StructureOf(entry)) {
    CheckTimeless(document, key, index);
    CheckStretch(document, JoinKey(key, kinds.front()), scenario.world.track.length_m, *stretch,
                 standing);
  }
}

}  // namespace

void CheckDisturbances(const YamlDocument& document, const Scenario& scenario) {
  std::vector<sim::StructureOptions> standing = scenario.world.structures;
  for (std::size_t i = 0; i < scenario.disturbances.size(); ++i) {
    CheckDisturbance(document, scenario, i, standing);
  }
}

}  // namespace polnav::testbed
