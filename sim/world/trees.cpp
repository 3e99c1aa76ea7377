#include <algorithm>

#include "sim/world/overgrowth.h"
#include "sim/world/street_things.h"

namespace polnav::sim {

void AddTrees(int count, const StreetFrame& street, std::uint64_t seed, SceneBuilder& scene) {
  scene.SetLabel(Label::kVegetation);
  const RandomStream stream(seed, 0, "plaza/trees");
  const TreeTextures textures = AddTreeTextures(stream, scene);
  for (int i = 0; i < count; ++i) {
    RandomStream::Sample random = stream.At(static_cast<std::uint64_t>(i) + 1);
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
