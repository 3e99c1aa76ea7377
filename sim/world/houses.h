// Which houses stand around the plaza?
#pragma once

#include <cstdint>

#include "sim/world/plaza.h"
#include "sim/world/scene_builder.h"
#include "sim/world/street_frame.h"

namespace polnav::sim {

void AddHouses(const PlazaOptions& options, const StreetFrame& street, std::uint64_t seed,
               SceneBuilder& scene);

}  // namespace polnav::sim
