#include "sim/world/ground.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/world/sweep.h"
#include "sim/world/texture_noise.h"
#include "sim/world/textures.h"

namespace polnav::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRoadTile_m = 8.0;
constexpr double kPlain = 0.02;   // detail that bare asphalt has left
constexpr int kRoadVariants = 7;  // the last one has a pedestrian crossing

class GroundBuilder {
 public:
  GroundBuilder(const StreetFrame& street, const std::vector<StructureOptions>& structures,
                std::uint64_t seed, SceneBuilder& scene)
      : street_(street),
        structures_(structures),
        scene_(scene),
        fine_(seed * 2 + 1, 1.7),
        coarse_(seed * 2 + 2, 9.0) {}

  // A grid over [s0, s1] along and the cross section (left-going) across.
  void AddStrip(double s0, double s1, int rows, const std::vector<Rib>& ribs, int texture,
                const UvOf& uv_of, double contrast = 1.0) {
    AddSweep(
        street_, {s0, s1, rows, ribs, texture}, uv_of,
        [&](double s, const Rib& rib, const Vector3d& p) {
          const bool is_road = std::abs(rib.offset_m) <= street_.half_road_m() + kKerbWidth_m;
          const double daylight = is_road ? DaylightAt(structures_, s, street_) : 1.0;
          return daylight * (1.0 + contrast * (Shade(p) - 1.0));
        },
        scene_);
  }

  // Around the whole loop, in pieces that can be culled; texture coordinates from the place.
  void AddBand(int pieces, int rows, const std::vector<Rib>& ribs, int texture, double repeat_m) {
    const double piece = street_.length_m() / pieces;
    for (int i = 0; i < pieces; ++i) {
      AddStrip(piece * i, piece * (i + 1), rows, ribs, texture,
               [repeat_m](double, int, const Vector3d& p) -> Vector2d {
                 return p.head<2>() / repeat_m;
               });
    }
  }

 private:
  [[nodiscard]] double Shade(const Vector3d& p) const {
    return std::max(0.4, 1.0 + 0.20 * fine_.At(p.x(), p.y()) + 0.25 * coarse_.At(p.x(), p.y()));
  }

  const StreetFrame& street_;
  const std::vector<StructureOptions>& structures_;
  SceneBuilder& scene_;
  GroundNoise fine_;
  GroundNoise coarse_;
};

void AddRoad(const StreetFrame& street, const std::vector<StructureOptions>& structures,
             std::uint64_t seed, GroundBuilder& ground, SceneBuilder& scene) {
  const RandomStream stream(seed, 0, "plaza/road");
  Sample base_random = stream.At(0);
  const cv::Mat base = scene.draws() ? FractalNoise(1024, {4, 10, 1.0}, base_random) : cv::Mat();
  std::vector<int> variants;
  for (int i = 0; i < kRoadVariants; ++i) {
    Sample random = stream.At(static_cast<std::uint64_t>(i) + 1);
    variants.push_back(
        scene.AddTexture([&] { return RoadTexture(base, i == kRoadVariants - 1, random); }));
  }
  Sample bare_random = stream.At(99);
  const bool has_bare = std::any_of(structures.begin(), structures.end(),
                                    [](const auto& s) { return s.kind == "plain_wall"; });
  const int bare =
      has_bare
          ? scene.AddTexture([&] { return PlainTexture(512, 54.0, 0.05, bare_random); }, kPlain)
          : 0;
  constexpr int kColumns = 4;
  std::vector<Rib> ribs;
  for (int k = 0; k <= kColumns; ++k) {
    ribs.push_back({street.half_road_m() * (2.0 * k / kColumns - 1.0), 0.0});
  }
  Sample random = stream.At(100);
  const int tiles = static_cast<int>(std::lround(street.length_m() / kRoadTile_m));
  const double tile = street.length_m() / tiles;
  for (int i = 0; i < tiles; ++i) {
    const bool crossing = i % 12 == 7;
    const auto variant = crossing ? kRoadVariants - 1 : random.Bits() % (kRoadVariants - 1);
    const bool mirrored = random.Uniform() < 0.5;
    const bool is_bare = IsBare(structures, tile * (i + 0.5), street);
    ground.AddStrip(
        tile * i, tile * (i + 1), 5, ribs, is_bare ? bare : variants[variant],
        [mirrored](double along, int rib, const Vector3d&) -> Vector2d {
          return {static_cast<double>(rib) / kColumns, mirrored ? 1.0 - along : along};
        },
        is_bare ? 0.1 : 1.0);
  }
}

// The kerb's top lies over the edge of what it holds back, its face reaches below the road: bands
// of different lengths of step meet without gaps.
void AddKerbs(const StreetFrame& street, GroundBuilder& ground, int concrete) {
  const double in = street.half_road_m();
  const double out = -street.half_road_m() - kBayWidth_m;
  const double top = kKerbHeight_m;
  const double below = -0.06;
  const int pieces = static_cast<int>(street.length_m() / 24.0) + 1;
  const double piece = street.length_m() / pieces;
  const auto kerb = [&](const std::vector<Rib>& ribs) {
    for (int i = 0; i < pieces; ++i) {
      ground.AddStrip(piece * i, piece * (i + 1), 12, ribs, concrete,
                      [piece](double along, int rib, const Vector3d&) -> Vector2d {
                        return {along * piece / 3.0, 0.1 * rib};
                      });
    }
  };
  kerb({{in, below}, {in, top}});
  kerb({{in, top}, {in + kKerbWidth_m, top}});
  kerb({{out - kKerbWidth_m, top}, {out, top}});
  kerb({{out, top}, {out, below}});
}

struct GroundTextures {
  int paving, cobbles, grass, concrete;
};

// Each band lies a little lower than its neighbour on the road's side and reaches under it.
constexpr double kStep_m = 0.03;
constexpr double kUnder_m = 0.25;

// From the inner kerb to the centre: path, grass, and a paved round in the middle.
void AddPark(const StreetFrame& street, const GroundTextures& textures, GroundBuilder& ground) {
  const double path = kKerbHeight_m - kStep_m;
  const double lawn = path - kStep_m;
  const double meadow = lawn - kStep_m;
  const double middle = meadow - kStep_m;
  const double radius = street.radius_m();
  const double kerb = street.half_road_m() + kKerbWidth_m;
  const double path_end = kerb + kInnerPath_m;
  const double round = std::max(0.75 * radius, 0.5 * (path_end + radius));
  const double lawn_end = std::min(path_end + 7.0, 0.5 * (path_end + round));
  ground.AddBand(24, 8, {{kerb - 0.2, path}, {path_end, path}}, textures.paving, 4.0);
  ground.AddBand(
      24, 8,
      {{path_end - kUnder_m, lawn}, {0.8 * path_end + 0.2 * lawn_end, lawn}, {lawn_end, lawn}},
      textures.grass, 3.7);
  ground.AddBand(
      12, 7, {{lawn_end - kUnder_m, meadow}, {0.5 * (lawn_end + round), meadow}, {round, meadow}},
      textures.grass, 3.7);
  ground.AddBand(6, 5,
                 {{round - kUnder_m, middle}, {0.5 * (round + radius), middle}, {radius, middle}},
                 textures.paving, 4.0);
}

// From the road's outer edge outwards: parking bay, pavement, grass, forecourts, the town.
void AddOutside(const StreetFrame& street, const GroundTextures& textures, GroundBuilder& ground) {
  const double edge = -street.half_road_m();
  const double bay = edge - kBayWidth_m;
  const double pavement = bay - kKerbWidth_m - kOuterPavement_m;
  const double verge = pavement - kVerge_m;
  const double forecourt = verge - 24.0;
  const double high = kKerbHeight_m - kStep_m;
  ground.AddBand(24, 8, {{bay - 0.1, -kStep_m}, {bay + 1.2, -kStep_m}, {edge + kUnder_m, -kStep_m}},
                 textures.cobbles, 2.6);
  ground.AddBand(24, 8,
                 {{pavement, high}, {pavement + 3.0, high}, {bay - kKerbWidth_m + 0.2, high}},
                 textures.paving, 4.0);
  ground.AddBand(24, 5, {{verge, high - kStep_m}, {pavement + kUnder_m, high - kStep_m}},
                 textures.grass, 3.7);
  const double low = high - 2.0 * kStep_m;
  ground.AddBand(24, 4, {{forecourt, low}, {verge - 10.0, low}, {verge + kUnder_m, low}},
                 textures.cobbles, 5.2);
  const double lowest = low - kStep_m;
  ground.AddBand(12, 4,
                 {{verge - 200.0, lowest}, {verge - 80.0, lowest}, {forecourt + kUnder_m, lowest}},
                 textures.concrete, 23.0);
}

}  // namespace

void AddGround(const StreetFrame& street, const std::vector<StructureOptions>& structures,
               std::uint64_t seed, SceneBuilder& scene) {
  scene.SetLabel(Label::kGround);
  GroundBuilder ground(street, structures, seed, scene);
  AddRoad(street, structures, seed, ground, scene);
  Sample random = RandomStream(seed, 0, "plaza/ground").At(0);
  // Braces keep the order of the draws.
  const GroundTextures textures{scene.AddTexture([&] { return PavingTexture(8, 1.0, random); }),
                                scene.AddTexture([&] { return PavingTexture(16, 1.3, random); }),
                                scene.AddTexture([&] { return GrassTexture(random); }),
                                scene.AddTexture([&] { return PavingTexture(2, 1.2, random); })};
  AddKerbs(street, ground, textures.concrete);
  AddPark(street, textures, ground);
  AddOutside(street, textures, ground);
}

}  // namespace polnav::sim
