#include "sim/world/ground.h"

#include <Eigen/Geometry>
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
        const Vector3d along = Point(s + 0.5 * step, ribs[near]) - Point(s - 0.5 * step, ribs[near]);
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
    return std::max(0.4, 1.0 + 0.30 * fine_.At(p.x(), p.y()) + 0.28 * coarse_.At(p.x(), p.y()));
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
  const cv::Mat base = FractalNoise(1024, {2, 10, 0.9}, base_random);
  std::vector<int> variants;
  for (int i = 0; i < kRoadVariants; ++i) {
    Sample random = stream.At(static_cast<std::uint64_t>(i) + 1);
    variants.push_back(scene.AddTexture(RoadTexture(base, i == kRoadVariants - 1, random)));
  }
  constexpr int kColumns = 6;
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
    ground.AddStrip(tile * i, tile * (i + 1), 7, ribs, variants[variant],
                    [mirrored](double along, int rib, const Vector3d&) -> Vector2d {
                      return {static_cast<double>(rib) / kColumns, mirrored ? 1.0 - along : along};
                    });
  }
}

void AddKerbs(const StreetFrame& street, GroundBuilder& ground, int concrete) {
  const double in = street.half_road_m();
  const double out = -street.half_road_m() - kBayWidth_m;
  const double h = kKerbHeight_m;
  const int pieces = static_cast<int>(street.length_m() / 24.0) + 1;
  const double piece = street.length_m() / pieces;
  const auto kerb = [&](const std::vector<Rib>& ribs, double width) {
    for (int i = 0; i < pieces; ++i) {
      ground.AddStrip(piece * i, piece * (i + 1), 12, ribs, concrete,
                      [piece, width](double along, int rib, const Vector3d&) -> Vector2d {
                        return {along * piece / 3.0, rib * width / 3.0};
                      });
    }
  };
  kerb({{in, 0.0}, {in, h}}, h);
  kerb({{in, h}, {in + kKerbWidth_m, h}}, kKerbWidth_m);
  kerb({{out - kKerbWidth_m, h}, {out, h}}, kKerbWidth_m);
  kerb({{out, h}, {out, 0.0}}, h);
}

}  // namespace

void AddGround(const StreetFrame& street, std::uint64_t seed, SceneBuilder& scene) {
  GroundBuilder ground(street, seed, scene);
  AddRoad(street, seed, ground, scene);

  const RandomStream stream(seed, 0, "plaza/ground");
  Sample random = stream.At(0);
  const int paving = scene.AddTexture(PavingTexture(8, 1.0, random));
  const int cobbles = scene.AddTexture(PavingTexture(16, 1.3, random));
  const int grass = scene.AddTexture(GrassTexture(random));
  const int concrete = scene.AddTexture(PavingTexture(2, 1.2, random));
  AddKerbs(street, ground, concrete);

  const double h = kKerbHeight_m;
  const double in = street.half_road_m() + kKerbWidth_m;
  const double path = in + kInnerPath_m;
  const double bay = -street.half_road_m() - kBayWidth_m;
  const double pavement = bay - kKerbWidth_m - kOuterPavement_m;
  const double verge = pavement - kVerge_m;
  const double radius = street.radius_m();
  const double round = 0.75 * radius;  // the middle of the park is paved
  ground.AddBand(24, 10, {{bay, 0.0}, {0.5 * (bay - 0.5 * street.half_road_m() * 2.0), 0.0},
                          {-street.half_road_m(), 0.0}},
                 cobbles, 2.6);
  ground.AddBand(24, 12, {{in, h}, {in + 1.5, h}, {path, h}}, paving, 4.0);
  ground.AddBand(24, 10, {{path, h}, {path + 1.5, h}, {path + 3.5, h}, {path + 7.0, h}}, grass, 3.7);
  ground.AddBand(12, 8, {{path + 7.0, h}, {path + 13.0, h}, {0.5 * (path + 13.0 + round), h},
                         {round, h}}, grass, 3.7);
  ground.AddBand(6, 6, {{round, h}, {0.5 * (round + radius), h}, {radius, h}}, paving, 4.0);
  ground.AddBand(24, 10, {{pavement, h}, {pavement + 2.0, h}, {pavement + 4.0, h},
                          {bay - kKerbWidth_m, h}}, paving, 4.0);
  ground.AddBand(24, 7, {{verge, h}, {pavement, h}}, grass, 3.7);
  ground.AddBand(24, 5, {{verge - 24.0, h}, {verge - 10.0, h}, {verge, h}}, cobbles, 5.2);
  ground.AddBand(12, 4, {{verge - 200.0, h}, {verge - 80.0, h}, {verge - 24.0, h}}, concrete, 23.0);
}

}  // namespace polnav::sim
