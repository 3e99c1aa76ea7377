#include <array>
#include <cmath>

#include "sim/world/street_things.h"
#include "sim/world/textures.h"

namespace polnav::sim {
namespace {

using Eigen::Vector3d;

struct TreeTextures {
  int bark = 0;
  std::array<int, 2> foliage{};
};

void AddTree(const Vector3d& foot, double height_m, double crown_m, const TreeTextures& textures,
             Sample& random, SceneBuilder& scene) {
  const double trunk = 0.38 * height_m;
  const Vector3d fork = foot + Vector3d(0.2 * random.Gaussian(), 0.2 * random.Gaussian(), trunk);
  const double radius = 0.025 * height_m;
  scene.AddPole({foot - 0.3 * Vector3d::UnitZ(), fork, 1.3 * radius, radius, 7}, textures.bark, 0.8,
                1.0);
  const int foliage = textures.foliage[random.Bits() % 2];
  const double shade = 0.7 + 0.6 * random.Uniform();
  // One crown in the middle, others around it; all stay within crown_m of the trunk's axis.
  const Vector3d middle = foot + Vector3d(0.0, 0.0, 0.68 * height_m);
  scene.AddBlob(middle, {0.62 * crown_m, 0.62 * crown_m, 0.32 * height_m}, foliage, shade, random);
  for (int i = 0; i < 2; ++i) {
    const double angle = 3.1 * i + 2.0 * random.Uniform();
    const double r = 0.36 * crown_m * (0.7 + 0.6 * random.Uniform());
    const Vector3d center =
        middle + Vector3d(0.45 * crown_m * std::cos(angle), 0.45 * crown_m * std::sin(angle),
                          0.13 * height_m * (2.0 * random.Uniform() - 1.4));
    scene.SetDetail(true);
    scene.AddPole({fork - 0.3 * Vector3d::UnitZ(), center, 0.5 * radius, 0.2 * radius, 5},
                  textures.bark, 0.8, 0.9);
    scene.SetDetail(false);
    scene.AddBlob(center, {r, r, 0.9 * r}, foliage, shade * (0.85 + 0.3 * random.Uniform()),
                  random);
  }
}

}  // namespace

void AddTrees(int count, const StreetFrame& street, std::uint64_t seed, SceneBuilder& scene) {
  const RandomStream stream(seed, 0, "plaza/trees");
  Sample texture_random = stream.At(0);
  TreeTextures textures;
  textures.bark = scene.AddTexture(BarkTexture(texture_random));
  for (int& foliage : textures.foliage) foliage = scene.AddTexture(FoliageTexture(texture_random));
  for (int i = 0; i < count; ++i) {
    Sample random = stream.At(static_cast<std::uint64_t>(i) + 1);
    const double crown = 1.6 + 1.3 * random.Uniform();
    const double height = 4.5 + 5.0 * random.Uniform();
    const double s = street.length_m() * (i + 0.7 * random.Uniform()) / std::max(1, count);
    // Two in five along the outer pavement, the others in the park; crowns end before the kerb.
    const double clearance = street.half_road_m() + crown * 1.1 + 0.5;
    const double depth = random.Uniform();
    const double offset = i % 5 < 2 ? -clearance - kBayWidth_m - 3.0 * depth
                                    : clearance + kInnerPath_m + 22.0 * depth * depth;
    AddTree(street.At(s, offset, kKerbHeight_m), height, crown, textures, random, scene);
  }
}

}  // namespace polnav::sim
