// When does which disturbance happen in this trial?
#pragma once

#include <cstdint>
#include <vector>

#include "nav/api/time.h"
#include "sim/disturbances/disturbance_options.h"
#include "sim/sensors/camera_conditions.h"

namespace polnav::sim {

// One occurrence.
struct DisturbanceEvent {
  double start_s = 0.0;
  double end_s = 0.0;
  DisturbanceOptions what;
};

// Every occurrence that begins within the duration, entry by entry; stretches of road do not occur.
// An entry's random times depend on its place in the list and the key, on nothing else.
[[nodiscard]] std::vector<DisturbanceEvent> ScheduleDisturbances(
    const std::vector<DisturbanceOptions>& entries, double duration_s, std::uint64_t seed,
    std::uint64_t trial);

// What of it cameras see through: effects rise and fall over a second, or over a quarter of their
// duration where that is shorter; effects that overlap add up.
[[nodiscard]] CameraConditions ConditionsAt(const std::vector<DisturbanceEvent>& events,
                                            nav::TimeNs stamp);

}  // namespace polnav::sim
