// What lies on the ground: road, kerbs, pavement, grass.
#pragma once

#include <cstdint>

#include "sim/world/scene_builder.h"
#include "sim/world/street_frame.h"

namespace polnav::sim {

void AddGround(const StreetFrame& street, std::uint64_t seed, SceneBuilder& scene);

}  // namespace polnav::sim
