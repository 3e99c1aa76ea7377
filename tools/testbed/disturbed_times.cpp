#include "tools/testbed/disturbed_times.h"

#include <cmath>
#include <optional>

#include "sim/disturbances/schedule.h"
#include "sim/world/track.h"

namespace polnav::testbed {
namespace {

const std::optional<sim::StretchOptions>& RoadOf(const sim::DisturbanceOptions& entry) {
  for (const auto* road : {&entry.low_features, &entry.canopy, &entry.tunnel}) {
    if (*road) return *road;
  }
  return entry.bridge;
}

// Where along the lap the vehicle was at each truth.
std::vector<double> ArcLengths(const sim::Track& track, const std::vector<sim::Truth>& truth) {
  std::vector<double> s_m;
  for (const sim::Truth& t : truth) s_m.push_back(track.Project(t.T_WB.p.head<2>()).s_m);
  return s_m;
}

void AddPassages(const sim::StretchOptions& road, double lap_m,
                 const std::vector<sim::Truth>& truth, const std::vector<double>& s_m,
                 std::vector<Stretch>& times) {
  bool before = false;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    double into_m = std::fmod(s_m[i] - road.start_m, lap_m);
    if (into_m < 0.0) into_m += lap_m;
    const bool on = into_m <= road.length_m;
    const double t_s = nav::ToSeconds(truth[i].stamp);
    if (on && !before) times.push_back({t_s, t_s});
    if (on) times.back().end_s = t_s;
    before = on;
  }
}

}  // namespace

std::vector<Stretch> DisturbedTimes(const Scenario& scenario, std::uint64_t trial,
                                    const std::vector<sim::Truth>& truth) {
  std::vector<Stretch> times;
  for (const sim::DisturbanceEvent& event : sim::ScheduleDisturbances(
           scenario.disturbances, scenario.duration_s, scenario.seed, trial)) {
    times.push_back({event.start_s, event.end_s});
  }
  std::optional<sim::Track> track;
  std::vector<double> s_m;
  for (const sim::DisturbanceOptions& entry : scenario.disturbances) {
    const auto& road = RoadOf(entry);
    if (!road) continue;
    if (!track) s_m = ArcLengths(track.emplace(scenario.world.track), truth);
    AddPassages(*road, track->length_m(), truth, s_m, times);
  }
  return times;
}

std::vector<Stretch> FaultTimes(const std::vector<sim::FaultOptions>& faults, double end_s) {
  std::vector<Stretch> times;
  for (const sim::FaultOptions& fault : faults) {
    times.push_back({fault.start_s, fault.duration_s ? fault.start_s + *fault.duration_s : end_s});
  }
  return times;
}

}  // namespace polnav::testbed
