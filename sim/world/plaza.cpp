#include "sim/world/plaza.h"

#include <algorithm>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>

#include "sim/world/ground.h"
#include "sim/world/houses.h"
#include "sim/world/scene_builder.h"
#include "sim/world/street_frame.h"
#include "sim/world/street_things.h"

namespace polnav::sim {
namespace {

// Pulls every texture towards its mean, and every vertex's shade towards one.
void ScaleContrast(double contrast, Scene& scene) {
  if (contrast == 1.0) return;
  for (cv::Mat& texture : scene.textures) {
    const double mean = cv::mean(texture)[0];
    texture.convertTo(texture, CV_8UC1, contrast, (1.0 - contrast) * mean);
  }
  for (Mesh& mesh : scene.meshes) {
    for (Vertex& v : mesh.vertices) {
      v.shade = std::max(0.0F, 1.0F + static_cast<float>(contrast) * (v.shade - 1.0F));
    }
  }
}

}  // namespace

Scene BuildPlaza(const PlazaOptions& options, const Track& track, const Terrain& terrain,
                 std::uint64_t seed) {
  // Kerb, path and some park must fit inside.
  const double least_radius = 0.5 * track.road_width_m() + kKerbWidth_m + kInnerPath_m + 2.0;
  if (track.mean_radius_m() < least_radius) {
    throw std::invalid_argument("a loop of " + std::to_string(track.length_m()) +
                                " m is too short for a plaza with a road " +
                                std::to_string(track.road_width_m()) + " m wide");
  }
  const StreetFrame street(track, terrain);
  SceneBuilder builder;
  AddGround(street, seed, builder);
  AddHouses(options, street, seed, builder);
  AddTrees(options.tree_count, street, seed, builder);
  AddStreetThings(options, street, seed, builder);
  Scene scene = builder.Take();
  ScaleContrast(options.texture_contrast, scene);
  return scene;
}

}  // namespace polnav::sim
