#include "sim/faults/fault_options.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <stdexcept>

namespace polnav::sim {
namespace {

double EndOf(const FaultOptions& fault) {
  return fault.duration_s ? fault.start_s + *fault.duration_s
                          : std::numeric_limits<double>::infinity();
}

bool ChangesReadings(FaultKind kind) { return kind <= FaultKind::kCorrupt; }

bool IsOneOf(const std::string& word, std::initializer_list<const char*> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

const char* NameOf(FaultKind kind) {
  static constexpr std::array kNames = {"stuck",        "bias",      "drift", "noise",
                                        "dead_channel", "corrupt",   "clock", "off",
                                        "drop",         "duplicate", "delay", "reorder"};
  return kNames.at(static_cast<std::size_t>(kind));
}

const std::vector<FaultKind>& AllFaultKinds() {
  static const std::vector<FaultKind> kinds = [] {
    std::vector<FaultKind> all;
    for (int k = 0; k <= static_cast<int>(FaultKind::kReorder); ++k) {
      all.push_back(static_cast<FaultKind>(k));
    }
    return all;
  }();
  return kinds;
}

std::vector<FaultKind> KindsGiven(const FaultOptions& f) {
  const std::array<bool, 12> given = {
      f.stuck.has_value(),     f.bias.has_value(),         f.drift.has_value(),
      f.noise.has_value(),     f.dead_channel.has_value(), f.corrupt.has_value(),
      f.clock.has_value(),     f.off.has_value(),          f.drop.has_value(),
      f.duplicate.has_value(), f.delay.has_value(),        f.reorder.has_value()};
  std::vector<FaultKind> kinds;
  for (const FaultKind kind : AllFaultKinds()) {
    if (given.at(static_cast<std::size_t>(kind))) kinds.push_back(kind);
  }
  return kinds;
}

const Amounts* AmountsOf(const FaultOptions& fault) {
  if (fault.bias) return &*fault.bias;
  if (fault.drift) return &*fault.drift;
  if (fault.noise) return &*fault.noise;
  return nullptr;
}

const std::vector<std::string>& AllSensors() {
  static const std::vector<std::string> sensors = {
      "imu",  "stereo",   "stereo_features", "polarimeter", "polarization_camera",
      "flow", "reference"};
  return sensors;
}

bool KindFits(FaultKind kind, const std::string& sensor) {
  if (kind == FaultKind::kDeadChannel) {
    return IsOneOf(sensor, {"polarimeter", "polarization_camera"});
  }
  if (kind == FaultKind::kCorrupt) return IsOneOf(sensor, {"stereo", "polarization_camera"});
  return true;
}

std::vector<std::string> AmountsGiven(const Amounts& a) {
  std::vector<std::string> keys;
  const auto add = [&](const char* key, bool given) {
    if (given) keys.emplace_back(key);
  };
  add("gyro_deg_s", !a.gyro_deg_s.isZero(0.0));
  add("accel_mg", !a.accel_mg.isZero(0.0));
  add("level", a.level != 0.0);
  add("feature_px", !a.feature_px.isZero(0.0));
  add("flow_x_deg_s", a.flow_x_deg_s != 0.0);
  add("flow_y_deg_s", a.flow_y_deg_s != 0.0);
  add("range_m", a.range_m != 0.0);
  add("position_m", !a.position_m.isZero(0.0));
  add("velocity_m_s", !a.velocity_m_s.isZero(0.0));
  add("heading_deg", a.heading_deg != 0.0);
  add("channel", a.channel != -1);
  add("side", a.side != "both");
  return keys;
}

bool AmountFits(const std::string& amount, const std::string& sensor) {
  static const std::map<std::string, std::vector<std::string>> amounts = {
      {"imu", {"gyro_deg_s", "accel_mg"}},
      {"stereo", {"level", "side"}},
      {"stereo_features", {"feature_px"}},
      {"polarimeter", {"level", "channel"}},
      {"polarization_camera", {"level", "channel"}},
      {"flow", {"gyro_deg_s", "flow_x_deg_s", "flow_y_deg_s", "range_m"}},
      {"reference", {"position_m", "velocity_m_s", "heading_deg"}}};
  const auto found = amounts.find(sensor);
  if (found == amounts.end()) throw std::logic_error("AmountFits: no sensor is called " + sensor);
  return std::find(found->second.begin(), found->second.end(), amount) != found->second.end();
}

bool ExcludeEachOther(const FaultOptions& a, const FaultOptions& b) {
  if (a.off || b.off) return true;
  const FaultKind kind_a = KindsGiven(a).at(0);
  const FaultKind kind_b = KindsGiven(b).at(0);
  if (a.stuck) return ChangesReadings(kind_b);
  if (b.stuck) return ChangesReadings(kind_a);
  if (a.dead_channel && b.dead_channel) return a.dead_channel->channel == b.dead_channel->channel;
  return kind_a == kind_b;
}

bool OverlapInTime(const FaultOptions& a, const FaultOptions& b) {
  return a.start_s < EndOf(b) && b.start_s < EndOf(a);
}

}  // namespace polnav::sim
