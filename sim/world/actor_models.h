// What do cars, buses and people look like from 3 to 30 m away?
//
// Meshes in the actor's own frame A: origin on the ground below the middle, x forward, z up. A few
// hundred triangles each, painted with the textures of actor_textures.h. Wheels do not turn, and
// people glide in mid-stride.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/random.h"
#include "sim/world/scene.h"
#include "sim/world/scene_builder.h"

namespace polnav::sim {

// Indices into Scene::textures.
struct ActorTextures {
  std::array<int, 6> cars{};  // shape i % 3
  int bus = 0;
  int paint = 0;  // plain: tyres, skin
  std::array<int, 3> cloth{};
};

// Draws them, for every actor to share.
[[nodiscard]] ActorTextures AddActorTextures(std::uint64_t seed, SceneBuilder& scene);

[[nodiscard]] std::vector<Mesh> CarMeshes(const ActorTextures& textures,
                                          RandomStream::Sample& random);
[[nodiscard]] std::vector<Mesh> BusMeshes(const ActorTextures& textures);  // 12 x 2.55 x 3.2 m
[[nodiscard]] std::vector<Mesh> PersonMeshes(const ActorTextures& textures,
                                             RandomStream::Sample& random);  // about 1.72 m

[[nodiscard]] Actor MakeCar(std::string name, std::vector<ActorKey> path,
                            const ActorTextures& textures, RandomStream::Sample& random);
[[nodiscard]] Actor MakeBus(std::string name, std::vector<ActorKey> path,
                            const ActorTextures& textures);
[[nodiscard]] Actor MakePedestrian(std::string name, std::vector<ActorKey> path,
                                   const ActorTextures& textures, RandomStream::Sample& random);

}  // namespace polnav::sim
