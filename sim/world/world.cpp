#include "sim/world/world.h"

#include <algorithm>
#include <iterator>

#include "sim/world/actor_models.h"
#include "sim/world/scene_builder.h"
#include "sim/world/street_frame.h"

namespace polnav::sim {
namespace {

void Append(std::vector<Actor> actors, Scene& scene) {
  std::move(actors.begin(), actors.end(), std::back_inserter(scene.actors));
}

}  // namespace

bool HidesSky(const WorldOptions& options) {
  if (options.sky_view != "auto") return options.sky_view == "scene";
  const TrafficOptions& traffic = options.traffic;
  return !options.structures.empty() || !options.actors.empty() || options.scene_file ||
         !options.passers.empty() || traffic.cars + traffic.buses + traffic.pedestrians > 0;
}

Scene BuildWorld(const WorldOptions& options, const Track& track, const Terrain& terrain,
                 std::uint64_t seed, double end_s, bool draws) {
  constexpr double kCell_m = 32.0;
  const StreetFrame street(track, terrain);
  SceneBuilder builder(kCell_m, draws);
  const ActorTextures textures = AddActorTextures(seed, builder);
  if (!options.scene_file || options.scene_file->with_plaza) {
    AddPlaza(options.plaza, options.structures, street, textures, seed, builder);
  }
  if (options.scene_file) AddSceneFile(*options.scene_file, builder);
  AddStructures(options.structures, street, seed, builder);
  Scene scene = builder.Take();
  Append(MakeTraffic(options.traffic, street, seed, end_s, textures), scene);
  Append(MakeActors(options.actors, street, seed, end_s, textures), scene);
  Append(MakePassers(options.passers, street, seed, textures), scene);
  ScaleContrast(options.plaza.texture_contrast, scene);
  return scene;
}

}  // namespace polnav::sim
