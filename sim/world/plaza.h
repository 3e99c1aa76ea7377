// What stands around the roundabout?
//
// A seeded plaza: a ring road with paint, patches, cracks and parked cars; a park with paths and
// trees inside; pavement, street lamps and house fronts outside. Everything stands on the terrain.
// Nothing reaches over the road, so that a zenith-looking sensor on it sees the sky alone.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/world/actor_models.h"
#include "sim/world/scene.h"
#include "sim/world/structures.h"
#include "sim/world/terrain.h"
#include "sim/world/track.h"

namespace polnav::sim {

// YAML keys = field names.
struct PlazaOptions {
  int tree_count = 70;              // in the park and along the outer pavement
  int lamp_count = 28;              // along the outer kerb
  int parked_car_count = 26;        // in the bay outside the road
  int furniture_count = 60;         // benches, bins, hedges, planters, signs
  double facade_height_m = 16.0;    // mean height of the houses
  double facade_distance_m = 19.0;  // of the nearest fronts from the road's edge
  double texture_contrast = 1.0;    // 0: every surface is plain grey; tracking gets lost

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("tree_count", tree_count, {.min = 0, .max = 1000});
    v("lamp_count", lamp_count, {.min = 0, .max = 200});
    v("parked_car_count", parked_car_count, {.min = 0, .max = 60});
    v("furniture_count", furniture_count, {.min = 0, .max = 1000});
    v("facade_height_m", facade_height_m, {.min = 4.0, .max = 60.0});
    v("facade_distance_m", facade_distance_m, {.min = 12.0, .max = 60.0});
    v("texture_contrast", texture_contrast, {.min = 0.0, .max = 1.5});
  }
};

// The ground is dimmer under structures, which themselves are not part of the plaza.
// Throws std::invalid_argument when the loop has no room for a park.
void AddPlaza(const PlazaOptions& options, const std::vector<StructureOptions>& structures,
              const StreetFrame& street, const ActorTextures& textures, std::uint64_t seed,
              SceneBuilder& scene);

// Pulls every texture towards its mean, and every vertex's shade towards one.
void ScaleContrast(double contrast, Scene& scene);

// The plaza by itself.
[[nodiscard]] Scene BuildPlaza(const PlazaOptions& options, const Track& track,
                               const Terrain& terrain, std::uint64_t seed);

}  // namespace polnav::sim
