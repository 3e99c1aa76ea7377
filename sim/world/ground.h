// What lies on the ground: road, kerbs, pavement, grass.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/world/scene_builder.h"
#include "sim/world/street_frame.h"
#include "sim/world/structures.h"

namespace polnav::sim {

// Dimmer under structures, bare between plain walls.
void AddGround(const StreetFrame& street, const std::vector<StructureOptions>& structures,
               std::uint64_t seed, SceneBuilder& scene);

}  // namespace polnav::sim
