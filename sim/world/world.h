// What does the world consist of, and which scene is that?
//
// Track and terrain under the wheels; around them the plaza or a user's scene file; structures over
// the road; traffic, people and scripted actors that move.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/world/plaza.h"
#include "sim/world/scene.h"
#include "sim/world/scene_file.h"
#include "sim/world/structures.h"
#include "sim/world/terrain.h"
#include "sim/world/track.h"
#include "sim/world/traffic.h"

namespace polnav::sim {

// YAML keys = field names.
struct WorldOptions {
  // Draws the ground, what stands on it and the vehicle's way. 0: the run's own seed and trial do,
  // so that each trial has a world of its own; otherwise all share one.
  std::uint64_t seed = 0;
  TerrainOptions terrain;
  TrackOptions track;
  PlazaOptions plaza;
  std::vector<StructureOptions> structures;
  TrafficOptions traffic;
  std::vector<ActorOptions> actors;
  std::optional<SceneFileOptions> scene_file;
  // What polarimeter and sky camera see: `open`, the sky alone; `scene`, whatever hides it;
  // `auto`, the scene where there are structures, traffic, actors or a scene file. The bare plaza
  // reaches over no road, so that sensors that look at the zenith see the open sky there.
  std::string sky_view = "auto";
  // Of the ground's grains of 1 to 150 mm, one sigma over its mean reflectance: what the
  // optical-flow camera follows, and no other camera sees. Asphalt has some 0.1 to 0.2, a swept
  // floor a few hundredths.
  double grain_contrast = 0.1;
  std::vector<Passer> passers;  // not a key: what the scenario's disturbances make pass

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("seed", seed);
    v("terrain", terrain);
    v("track", track);
    v("plaza", plaza);
    v("structures", structures);
    v("traffic", traffic);
    v("actors", actors);
    v("scene_file", scene_file);
    v("sky_view", sky_view, {"auto", "open", "scene"});
    v("grain_contrast", grain_contrast, {.min = 0.0, .max = 1.0});
  }
};

// Of what a plaza.texture_contrast leaves.
[[nodiscard]] inline double GrainContrast(const WorldOptions& options) {
  return options.grain_contrast * options.plaza.texture_contrast;
}

// True: what stands and moves around hides the sky from sensors. Whatever sensors there are.
[[nodiscard]] bool HidesSky(const WorldOptions& options);

// Actors move until end_s, and some seconds longer. draws: false leaves out the textures, which
// take most of the time, for sensors to whom only shapes matter.
// Throws std::invalid_argument when the loop is too short for a plaza or a scene file is unusable.
[[nodiscard]] Scene BuildWorld(const WorldOptions& options, const Track& track,
                               const Terrain& terrain, std::uint64_t seed, double end_s,
                               bool draws = true);

}  // namespace polnav::sim
