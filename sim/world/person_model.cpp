#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/world/actor_models.h"
#include "sim/world/actor_textures.h"
#include "sim/world/textures.h"

namespace polnav::sim {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

// A horizontal ellipse of a body: centre, half depth (x) and half breadth (y).
struct Ring {
  Vector3d center_m;
  double x_m, y_m;
};

struct Tube {
  std::vector<Ring> rings;  // upwards
  int texture;
  double shade;       // of the front half
  double back_shade;  // of the back half
};

// Smooth from ring to ring; open at both ends.
void AddTube(const Tube& tube, SceneBuilder& builder) {
  constexpr int kSides = 9;
  constexpr double kRepeats_m = 0.5;  // one repeat of the texture
  Mesh& mesh = builder.MeshAt(Vector3d::Zero(), tube.texture);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto count = tube.rings.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Ring& ring = tube.rings[i];
    const Ring& below = tube.rings[i == 0 ? 0 : i - 1];
    const Ring& above = tube.rings[std::min(i + 1, count - 1)];
    const double rise = std::max(1e-6, above.center_m.z() - below.center_m.z());
    const double slope = (below.x_m + below.y_m - above.x_m - above.y_m) / (2.0 * rise);
    for (int k = 0; k <= kSides; ++k) {
      const double around = 2.0 * pi * (k % kSides) / kSides;
      const Vector3d out(std::cos(around), std::sin(around), 0.0);
      const Vector3d p = ring.center_m + Vector3d(ring.x_m * out.x(), ring.y_m * out.y(), 0.0);
      const Vector3d normal =
          Vector3d(out.x() / std::max(1e-3, ring.x_m), out.y() / std::max(1e-3, ring.y_m), 0.0)
              .normalized() +
          slope * Vector3d::UnitZ();
      const double u = (ring.x_m + ring.y_m) * pi * k / kSides / kRepeats_m;
      const double shade = out.x() > -0.2 ? tube.shade : tube.back_shade;
      mesh.vertices.push_back(
          {p.cast<float>(), normal.normalized().cast<float>(),
           Eigen::Vector2f(static_cast<float>(u), static_cast<float>(-p.z() / kRepeats_m)),
           static_cast<float>(shade)});
    }
  }
  for (std::uint32_t i = 0; i + 1 < count; ++i) {
    for (std::uint32_t k = 0; k < kSides; ++k) {
      const std::uint32_t a = first + i * (kSides + 1) + k;
      const std::uint32_t b = a + kSides + 1;
      mesh.indices.insert(mesh.indices.end(), {a, a + 1, b + 1, a, b + 1, b});
    }
  }
}

double Between(Sample& random, double low, double high) {
  return low + (high - low) * random.Uniform();
}

struct Outfit {
  int top, bottom, skin;
  double top_shade, bottom_shade, skin_shade, hair_shade;
  bool has_coat;
};

Outfit DrawOutfit(const ActorTextures& textures, Sample& random) {
  Outfit outfit{};
  outfit.top = textures.cloth[random.Bits() % 3];
  outfit.bottom = textures.cloth[0];
  outfit.skin = textures.paint;
  outfit.top_shade = Between(random, 0.15, 1.3);
  outfit.bottom_shade = Between(random, 0.12, 0.6);
  outfit.skin_shade = Between(random, 0.35, 0.75);
  outfit.hair_shade = Between(random, 0.05, 0.25);
  outfit.has_coat = random.Uniform() < 0.4;
  return outfit;
}

// Mid-stride: one foot before, one behind.
void AddLegs(const Outfit& outfit, SceneBuilder& builder) {
  for (const double side : {-1.0, 1.0}) {
    const double step = 0.20 * side;
    const double y = 0.09 * side;
    AddTube({{{{step, y, 0.07}, 0.055, 0.05},
              {{0.75 * step + 0.03, y, 0.30}, 0.065, 0.06},
              {{0.45 * step + 0.05, y, 0.52}, 0.065, 0.065},
              {{0.0, 0.9 * y, 0.90}, 0.10, 0.095}},
             outfit.bottom,
             outfit.bottom_shade,
             outfit.bottom_shade},
            builder);
    builder.AddBox({{step + 0.05, y, 0.0}, 0.0, 0.27, 0.10, 0.09, 0.8}, outfit.skin, 1.0, 0.12);
    // The arm swings against the leg.
    AddTube({{{{-0.9 * step + 0.04, 0.27 * side, 0.80}, 0.03, 0.03},
              {{-0.7 * step, 0.27 * side, 0.90}, 0.04, 0.04},
              {{-0.35 * step - 0.02, 0.26 * side, 1.12}, 0.05, 0.05},
              {{0.0, 0.22 * side, 1.40}, 0.06, 0.06},
              {{0.0, 0.17 * side, 1.46}, 0.03, 0.03}},
             outfit.top,
             outfit.top_shade,
             outfit.top_shade},
            builder);
  }
}

void AddTorsoAndHead(const Outfit& outfit, SceneBuilder& builder) {
  std::vector<Ring> torso = {{{0.0, 0.0, 0.84}, 0.11, 0.17},  {{0.0, 0.0, 1.02}, 0.105, 0.15},
                             {{0.0, 0.0, 1.25}, 0.12, 0.185}, {{0.0, 0.0, 1.40}, 0.11, 0.20},
                             {{0.0, 0.0, 1.48}, 0.07, 0.11},  {{0.0, 0.0, 1.50}, 0.055, 0.055}};
  if (outfit.has_coat) torso.insert(torso.begin(), {{0.0, 0.0, 0.50}, 0.20, 0.21});
  AddTube({torso, outfit.top, outfit.top_shade, outfit.top_shade}, builder);
  AddTube({{{{0.0, 0.0, 1.47}, 0.05, 0.05},
            {{0.01, 0.0, 1.54}, 0.065, 0.06},
            {{0.02, 0.0, 1.62}, 0.095, 0.075},
            {{0.01, 0.0, 1.68}, 0.10, 0.08}},
           outfit.skin,
           outfit.skin_shade,
           outfit.hair_shade},
          builder);
  AddTube({{{{0.0, 0.0, 1.66}, 0.105, 0.085},
            {{0.0, 0.0, 1.71}, 0.09, 0.075},
            {{0.0, 0.0, 1.745}, 0.05, 0.045},
            {{0.0, 0.0, 1.75}, 0.0, 0.0}},
           outfit.skin,
           outfit.hair_shade,
           outfit.hair_shade},
          builder);
}

}  // namespace

ActorTextures AddActorTextures(std::uint64_t seed, SceneBuilder& scene) {
  const RandomStream stream(seed, 0, "world/actor_textures");
  constexpr std::array kPaints = {26.0, 120.0, 60.0, 205.0, 38.0, 165.0};
  ActorTextures textures;
  for (std::size_t i = 0; i < textures.cars.size(); ++i) {
    textures.cars[i] = scene.AddTexture([&] {
      Sample random = stream.At(i);
      return CarTexture(std::array{Saloon(), Hatchback(), OffRoader()}[i % 3], kPaints[i], random);
    });
  }
  textures.bus = scene.AddTexture([&] {
    Sample random = stream.At(100);
    return BusTexture(random);
  });
  textures.paint = scene.AddTexture([&] {
    Sample random = stream.At(101);
    return PlainTexture(256, 170.0, 0.25, random);
  });
  for (std::size_t i = 0; i < textures.cloth.size(); ++i) {
    textures.cloth[i] = scene.AddTexture([&] {
      Sample random = stream.At(200 + i);
      return ClothTexture(static_cast<int>(i), random);
    });
  }
  return textures;
}

std::vector<Mesh> PersonMeshes(const ActorTextures& textures, Sample& random) {
  SceneBuilder builder(std::numeric_limits<double>::infinity());
  builder.SetLabel(Label::kPerson);
  const Outfit outfit = DrawOutfit(textures, random);
  AddLegs(outfit, builder);
  AddTorsoAndHead(outfit, builder);
  std::vector<Mesh> meshes = builder.Take().meshes;
  const auto scale = static_cast<float>(1.0 + 0.045 * std::clamp(random.Gaussian(), -2.0, 2.0));
  for (Mesh& mesh : meshes) {
    for (Vertex& v : mesh.vertices) v.p_W_m *= scale;
  }
  return meshes;
}

Actor MakePedestrian(std::string name, std::vector<ActorKey> path, const ActorTextures& textures,
                     Sample& random) {
  return {std::move(name), PersonMeshes(textures, random), std::move(path)};
}

}  // namespace polnav::sim
