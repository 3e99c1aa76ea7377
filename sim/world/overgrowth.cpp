#include "sim/world/overgrowth.h"

#include <cmath>

#include "sim/world/textures.h"

namespace polnav::sim {
namespace {

using Eigen::Vector3d;

double Between(Sample& random, double low, double high) {
  return low + (high - low) * random.Uniform();
}

void AddCrown(const Vector3d& center, const Vector3d& radii, int foliage, double shade,
              Sample& random, SceneBuilder& scene) {
  scene.SetCover(kFoliageCover);
  scene.AddBlob(center, radii, foliage, shade, random);
  scene.SetCover(1.0);
}

// A tree whose boughs reach out to one side, over the road.
void AddArchingTree(const Vector3d& foot, const Vector3d& over_road, double clear_m,
                    const TreeTextures& textures, Sample& random, SceneBuilder& scene) {
  const Vector3d up = Vector3d::UnitZ();
  // It forks above the clear height: no bough hangs lower over the road.
  const Vector3d fork = foot + (clear_m + Between(random, 0.15, 0.6)) * up + 0.4 * over_road;
  const int foliage = textures.foliage[random.Bits() % 2];
  // Light comes through leaves from above: seen from below they are not as dark as a roof.
  const double shade = Between(random, 1.3, 1.9);
  scene.AddPole({foot - 0.3 * up, fork, 0.24, 0.15, 8}, textures.bark, 0.8, 1.0);
  const Vector3d along = up.cross(over_road);
  constexpr int kBoughs = 8;
  for (int i = 0; i < kBoughs; ++i) {
    const double reach = i == 0 ? -0.8 : 0.5 + 6.8 * (i - random.Uniform()) / (kBoughs - 1);
    const double radius = Between(random, 1.3, 2.1);
    const double half_height = 0.75 * radius;  // lumps reach a quarter beyond
    const Vector3d center = foot + reach * over_road + Between(random, -2.2, 2.2) * along +
                            (clear_m + 1.3 * half_height + Between(random, 0.1, 2.2)) * up;
    if (i % 2 == 1) {
      scene.AddPole({fork - 0.2 * up, center, 0.12, 0.04, 5}, textures.bark, 0.8, 0.8);
    }
    AddCrown(center, {radius, radius, half_height}, foliage, shade * Between(random, 0.8, 1.1),
             random, scene);
  }
}

}  // namespace

TreeTextures AddTreeTextures(const RandomStream& stream, SceneBuilder& scene) {
  Sample random = stream.At(0);
  TreeTextures textures;
  textures.bark = scene.AddTexture([&] { return BarkTexture(random); });
  for (int& foliage : textures.foliage) {
    foliage = scene.AddTexture([&] { return FoliageTexture(random); });
  }
  return textures;
}

void AddTree(const Vector3d& foot, double height_m, double crown_m, const TreeTextures& textures,
             Sample& random, SceneBuilder& scene) {
  const double trunk = 0.38 * height_m;
  const Vector3d fork = foot + Vector3d(0.2 * random.Gaussian(), 0.2 * random.Gaussian(), trunk);
  const double radius = 0.025 * height_m;
  scene.AddPole({foot - 0.3 * Vector3d::UnitZ(), fork, 1.3 * radius, radius, 7}, textures.bark, 0.8,
                1.0);
  const int foliage = textures.foliage[random.Bits() % 2];
  const double shade = 0.7 + 0.6 * random.Uniform();
  // One lump in the middle, others around and above it.
  const Vector3d middle = foot + Vector3d(0.0, 0.0, 0.66 * height_m);
  AddCrown(middle, {0.56 * crown_m, 0.56 * crown_m, 0.27 * height_m}, foliage, shade, random,
           scene);
  constexpr int kBoughs = 5;
  for (int i = 0; i < kBoughs; ++i) {
    const double angle = 2.0 * M_PI * (i + 0.6 * random.Uniform()) / kBoughs;
    const double r = 0.34 * crown_m * (0.8 + 0.5 * random.Uniform());
    const double out = 0.48 * crown_m;
    const Vector3d center =
        middle + Vector3d(out * std::cos(angle), out * std::sin(angle),
                          height_m * (i == 0 ? 0.20 : 0.26 * random.Uniform() - 0.16));
    scene.SetDetail(true);
    scene.AddPole({fork - 0.3 * Vector3d::UnitZ(), center, 0.5 * radius, 0.2 * radius, 4},
                  textures.bark, 0.8, 0.9);
    scene.SetDetail(false);
    AddCrown(center, {r, r, 0.85 * r}, foliage, shade * (0.8 + 0.4 * random.Uniform()), random,
             scene);
  }
}

void AddCanopy(const Canopy& canopy, const StreetFrame& street, const RandomStream& stream,
               SceneBuilder& scene) {
  constexpr double kSpacing_m = 5.5;
  const TreeTextures textures = AddTreeTextures(stream, scene);
  const int places = std::max(1, static_cast<int>(canopy.length_m / kSpacing_m));
  const double inner = street.half_road_m() + kKerbWidth_m + 0.5;
  const double outer = -street.half_road_m() - kBayWidth_m - 0.8;  // in line with the lamps
  for (int i = 0; i < 2 * places; ++i) {
    Sample random = stream.At(static_cast<std::uint64_t>(i) + 1);
    if (random.Uniform() >= canopy.density) continue;
    const double s =
        canopy.start_m + canopy.length_m * (i / 2 + Between(random, 0.3, 0.7)) / places;
    const double offset = i % 2 == 0 ? inner : outer;
    const Vector3d foot = street.At(s, offset, kKerbHeight_m);
    const Vector3d over_road =
        (street.At(s, 0.0) - street.At(s, offset)).cwiseProduct(Vector3d(1, 1, 0)).normalized();
    AddArchingTree(foot, over_road, canopy.clear_m, textures, random, scene);
  }
}

}  // namespace polnav::sim
