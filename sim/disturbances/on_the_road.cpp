#include "sim/disturbances/on_the_road.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace polnav::sim {
namespace {

constexpr double kSeenFrom_m = 120.0;
constexpr double kLeastSpeed_m_s = 0.2;  // of the difference: slower ones never come

struct NominalMotion {
  double s_m = 0.0;
  double speed_m_s = 0.0;
};

NominalMotion NominalAt(const VehicleOptions& vehicle, const Track& track, double t_s) {
  if (const auto place = PlaceOf(vehicle)) return {.s_m = track.Project(*place).s_m};
  const CarOptions car = vehicle.car.value_or(CarOptions{});
  return {.s_m = car.speed_m_s * std::max(0.0, t_s - car.start_delay_s),
          .speed_m_s = car.speed_m_s};
}

}  // namespace

std::optional<Eigen::Vector2d> PlaceOf(const VehicleOptions& vehicle) {
  if (vehicle.turntable) return Eigen::Vector2d(vehicle.turntable->position_m.head<2>());
  if (const auto& hexapod = vehicle.hexapod) {
    return Eigen::Vector2d(hexapod->start_east_m, hexapod->start_north_m);
  }
  return std::nullopt;
}

std::optional<StructureOptions> StructureOf(const DisturbanceOptions& entry) {
  for (const auto& [kind, stretch] :
       {std::pair("plain_wall", entry.low_features), std::pair("canopy", entry.canopy),
        std::pair("tunnel", entry.tunnel), std::pair("bridge", entry.bridge)}) {
    if (!stretch) continue;
    return StructureOptions{
        .kind = kind, .start_m = stretch->start_m, .length_m = stretch->length_m};
  }
  return std::nullopt;
}

std::vector<Passer> PassersOf(const std::vector<DisturbanceEvent>& events,
                              const VehicleOptions& vehicle, const Track& track) {
  std::vector<Passer> passers;
  for (const DisturbanceEvent& event : events) {
    if (!event.what.passing) continue;
    const PassingOptions& who = *event.what.passing;
    for (int k = 0; k < who.count; ++k) {
      const double alongside_s =
          event.start_s + (k + 0.5) / who.count * (event.end_s - event.start_s);
      const NominalMotion own = NominalAt(vehicle, track, alongside_s);
      const double closing_m_s = std::abs(who.speed_m_s - own.speed_m_s);
      if (closing_m_s < kLeastSpeed_m_s) continue;
      const double around_s = kSeenFrom_m / closing_m_s;
      passers.push_back({.kind = who.kind,
                         .s_m = own.s_m,
                         .at_s = alongside_s,
                         .offset_m = who.offset_m,
                         .speed_m_s = who.speed_m_s,
                         .begin_s = std::max(0.0, alongside_s - around_s),
                         .end_s = alongside_s + around_s});
    }
  }
  return passers;
}

std::vector<sky::CloudPassage> CloudPassages(const std::vector<DisturbanceEvent>& events,
                                             const VehicleOptions& vehicle, const Track& track) {
  std::vector<sky::CloudPassage> passages;
  for (const DisturbanceEvent& event : events) {
    if (!event.what.cloud_passage) continue;
    const double middle_s = 0.5 * (event.start_s + event.end_s);
    const Eigen::Vector2d over_m =
        PlaceOf(vehicle).value_or(track.At(NominalAt(vehicle, track, middle_s).s_m).p_m);
    passages.push_back({.over_m = over_m,
                        .middle_s = middle_s,
                        .duration_s = event.end_s - event.start_s,
                        .optical_depth = event.what.cloud_passage->optical_depth});
  }
  return passages;
}

WorldOptions WithDisturbances(WorldOptions world, const std::vector<DisturbanceOptions>& entries,
                              const std::vector<DisturbanceEvent>& events,
                              const VehicleOptions& vehicle, const Track& track) {
  for (const DisturbanceOptions& entry : entries) {
    if (const auto structure = StructureOf(entry)) world.structures.push_back(*structure);
  }
  world.passers = PassersOf(events, vehicle, track);
  return world;
}

}  // namespace polnav::sim
