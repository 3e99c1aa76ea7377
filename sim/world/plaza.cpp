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

void ScaleContrast(double contrast, Scene& scene) {
  if (contrast == 1.0) return;
  for (cv::Mat& texture : scene.textures) {
    const double mean = cv::mean(texture)[0];
    texture.convertTo(texture, CV_8UC1, contrast, (1.0 - contrast) * mean);
  }
  for (double& detail : scene.detail) detail *= std::min(1.0, contrast);
  for (Mesh& mesh : scene.meshes) {
    for (Vertex& v : mesh.vertices) {
      v.shade = std::max(0.0F, 1.0F + static_cast<float>(contrast) * (v.shade - 1.0F));
    }
  }
}

void AddPlaza(const PlazaOptions& options, const std::vector<StructureOptions>& structures,
              const StreetFrame& street, const ActorTextures& textures, std::uint64_t seed,
              SceneBuilder& scene) {
  // Kerb, path and some park must fit inside.
  const double least_radius = street.half_road_m() + kKerbWidth_m + kInnerPath_m + 2.0;
  if (street.radius_m() < least_radius) {
    throw std::invalid_argument("a loop of " + std::to_string(street.length_m()) +
                                " m is too short for a plaza with a road " +
                                std::to_string(2.0 * street.half_road_m()) + " m wide");
  }
  AddGround(street, structures, seed, scene);
  AddHouses(options, street, seed, scene);
  AddTrees(options.tree_count, street, seed, scene);
  AddStreetThings(options, street, textures, seed, scene);
}

Scene BuildPlaza(const PlazaOptions& options, const Track& track, const Terrain& terrain,
                 std::uint64_t seed) {
  const StreetFrame street(track, terrain);
  SceneBuilder builder;
  const ActorTextures textures = AddActorTextures(seed, builder);
  AddPlaza(options, {}, street, textures, seed, builder);
  Scene scene = builder.Take();
  ScaleContrast(options.texture_contrast, scene);
  return scene;
}

}  // namespace polnav::sim
