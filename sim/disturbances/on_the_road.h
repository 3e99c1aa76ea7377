// Who and what do the disturbances put on the road and over it?
//
// Stretches of road become structures, whoever passes becomes an actor that comes along the road.
// Where the vehicle is then, is only known nominally: a car at its speed after its start delay (it
// is some metres behind that, having had to speed up), a turntable where it stands, a hexapod where
// it starts.
#pragma once

#include <optional>
#include <vector>

#include "sim/disturbances/schedule.h"
#include "sim/vehicle/vehicle.h"
#include "sim/world/world.h"
#include "sky/clouds.h"

namespace polnav::sim {

// Of a vehicle that stays where it starts, or near it.
[[nodiscard]] std::optional<Eigen::Vector2d> PlaceOf(const VehicleOptions& vehicle);

// Of an entry that is a stretch of road.
[[nodiscard]] std::optional<StructureOptions> StructureOf(const DisturbanceOptions& entry);

// Those of the events who pass: at times spread evenly over an event they are alongside, and they
// are there from 120 m before to 120 m past the vehicle.
[[nodiscard]] std::vector<Passer> PassersOf(const std::vector<DisturbanceEvent>& events,
                                            const VehicleOptions& vehicle, const Track& track);

// Clouds that stand over the vehicle half way through their events.
[[nodiscard]] std::vector<sky::CloudPassage> CloudPassages(
    const std::vector<DisturbanceEvent>& events, const VehicleOptions& vehicle, const Track& track);

// The world with structures and passers.
[[nodiscard]] WorldOptions WithDisturbances(WorldOptions world,
                                            const std::vector<DisturbanceOptions>& entries,
                                            const std::vector<DisturbanceEvent>& events,
                                            const VehicleOptions& vehicle, const Track& track);

}  // namespace polnav::sim
