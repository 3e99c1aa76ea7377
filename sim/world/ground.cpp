#include "sim/world/ground.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "sim/world/texture_noise.h"
#include "sim/world/textures.h"

namespace polnav::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRoadTile_m = 8.0;
constexpr int kRoadVariants = 7;  // the last one has a pedestrian crossing

// A point of a cross section.
struct Rib {
  double offset_m;
  double lift_m;
};

using UvOf = std::function<Vector2d(double along_01, int rib, const Vector3d& p_m)>;

class GroundBuilder {
 public:
  GroundBuilder(const StreetFrame& street, std::uint64_t seed, SceneBuilder& scene)
      : street_(street), scene_(scene), fine_(seed * 2 + 1, 1.7), coarse_(seed * 2 + 2, 9.0) {}

  // A grid over [s0, s1] along and the cross section (left-going) across. Normals from the grid.
  void AddStrip(double s0, double s1, int rows, const std::vector<Rib>& ribs, int texture,
                const UvOf& uv_of) {
    Mesh& mesh = scene_.MeshAt(street_.At(0.5 * (s0 + s1), ribs.front().offset_m), texture);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const auto stride = static_cast<std::uint32_t>(ribs.size());
    const double step = (s1 - s0) / rows;
    for (int row = 0; row <= rows; ++row) {
      const double s = s0 + step * row;
      for (std::size_t k = 0; k < ribs.size(); ++k) {
        const Vector3d p = Point(s, ribs[k]);
        const std::size_t near = k + 1 < ribs.size() ? k : k - 1;
        const Vector3d across = Point(s, ribs[near + 1]) - Point(s, ribs[near]);
        const Vector3d along =
            Point(s + 0.5 * step, ribs[near]) - Point(s - 0.5 * step, ribs[near]);
        const Vector2d uv = uv_of(static_cast<double>(row) / rows, static_cast<int>(k), p);
        mesh.vertices.push_back({p.cast<float>(), along.cross(across).normalized().cast<float>(),
                                 uv.cast<float>(), static_cast<float>(Shade(p))});
      }
    }
    for (std::uint32_t row = 0; row < static_cast<std::uint32_t>(rows); ++row) {
      for (std::uint32_t k = 0; k + 1 < stride; ++k) {
        const std::uint32_t a = first + row * stride + k;
        const std::uint32_t b = a + stride;
        mesh.indices.insert(mesh.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
      }
    }
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
  [[nodiscard]] Vector3d Point(double s, const Rib& rib) const {
    return street_.At(s, rib.offset_m, rib.lift_m);
  }
  [[nodiscard]] double Shade(const Vector3d& p) const {
    return std::max(0.4, 1.0 + 0.20 * fine_.At(p.x(), p.y()) + 0.25 * coarse_.At(p.x(), p.y()));
  }

  const StreetFrame& street_;
  SceneBuilder& scene_;
  GroundNoise fine_;
  GroundNoise coarse_;
};

void AddRoad(const StreetFrame& street, std::uint64_t seed, GroundBuilder& ground,
             SceneBuilder& scene) {
  const RandomStream stream(seed, 0, "plaza/road");
  Sample base_random = stream.At(0);
  const cv::Mat base = FractalNoise(1024, {3, 10, 0.95}, base_random);
  std::vector<int> variants;
  for (int i = 0; i < kRoadVariants; ++i) {
    Sample random = stream.At(static_cast<std::uint64_t>(i) + 1);
    variants.push_back(scene.AddTexture(RoadTexture(base, i == kRoadVariants - 1, random)));
  }
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
    ground.AddStrip(tile * i, tile * (i + 1), 5, ribs, variants[variant],
                    [mirrored](double along, int rib, const Vector3d&) -> Vector2d {
                      return {static_cast<double>(rib) / kColumns, mirrored ? 1.0 - along : along};
                    });
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

void AddGround(const StreetFrame& street, std::uint64_t seed, SceneBuilder& scene) {
  GroundBuilder ground(street, seed, scene);
  AddRoad(street, seed, ground, scene);
  Sample random = RandomStream(seed, 0, "plaza/ground").At(0);
  // Braces keep the order of the draws.
  const GroundTextures textures{scene.AddTexture(PavingTexture(8, 1.0, random)),
                                scene.AddTexture(PavingTexture(16, 1.3, random)),
                                scene.AddTexture(GrassTexture(random)),
                                scene.AddTexture(PavingTexture(2, 1.2, random))};
  AddKerbs(street, ground, textures.concrete);
  AddPark(street, textures, ground);
  AddOutside(street, textures, ground);
}

}  // namespace polnav::sim
