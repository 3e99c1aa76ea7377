#include "tools/testbed/world_check.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "sim/world/actor_path.h"

namespace polnav::testbed {
namespace {

void CheckActors(const YamlDocument& document, const std::vector<sim::ActorOptions>& actors) {
  for (std::size_t i = 0; i < actors.size(); ++i) {
    try {
      sim::CheckPath(actors[i].path_m);
    } catch (const std::invalid_argument& error) {
      FailAt(document, fmt::format("world.actors.{}.path_m", i), error.what());
    }
  }
}

}  // namespace

void ResolveSceneFile(const YamlDocument& document, sim::WorldOptions& world) {
  if (!world.scene_file) return;
  world.scene_file->folder = std::filesystem::path(document.file).parent_path().string();
}

void CheckWorld(const YamlDocument& document, const sim::WorldOptions& world) {
  if (const auto fault = sim::FindFault(world.structures, world.track.length_m)) {
    FailAt(document, fmt::format("world.structures.{}.{}", fault->index, fault->key),
           fault->message);
  }
  constexpr double kTwoLanes_m = 7.6;
  if (world.traffic.cars + world.traffic.buses > 0 && world.track.road_width_m < kTwoLanes_m) {
    FailAt(document, "world.traffic",
           fmt::format("cars and buses pass the ego on both sides: they need a road_width_m of {} "
                       "or more, the track has {}",
                       kTwoLanes_m, world.track.road_width_m));
  }
  CheckActors(document, world.actors);
  if (!world.scene_file) return;
  if (world.scene_file->path.empty()) {
    FailAt(document, "world.scene_file.path", "expected the path of a glTF or OBJ file");
  }
  try {
    sim::SceneBuilder scene;
    sim::AddSceneFile(*world.scene_file, scene);
  } catch (const std::invalid_argument& error) {
    FailAt(document, "world.scene_file.path", error.what());
  }
}

}  // namespace polnav::testbed
