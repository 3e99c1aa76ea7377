// What stands in the street and in the park: trees, lamps, parked cars, benches, hedges.
#pragma once

#include <cstdint>

#include "sim/world/actor_models.h"
#include "sim/world/plaza.h"
#include "sim/world/scene_builder.h"
#include "sim/world/street_frame.h"

namespace polnav::sim {

void AddTrees(int count, const StreetFrame& street, std::uint64_t seed, SceneBuilder& scene);
void AddStreetThings(const PlazaOptions& options, const StreetFrame& street,
                     const ActorTextures& textures, std::uint64_t seed, SceneBuilder& scene);

}  // namespace polnav::sim
