#include "sim/world/structures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sim/world/overgrowth.h"
#include "sim/world/sweep.h"
#include "sim/world/texture_noise.h"
#include "sim/world/textures.h"

namespace polnav::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPlain = 0.02;  // detail that a smooth wall has
constexpr double kWallThickness_m = 0.33;
constexpr double kBeforeKerb_m = 0.03;  // plain walls hide the kerb's face
constexpr double kBehindKerb_m = 0.25;  // a tunnel's leave room for what overhangs the kerb

double HeightOf(const StructureOptions& structure) {
  const double by_kind =
      structure.kind == "plain_wall" ? 8.0 : (structure.kind == "bridge" ? 5.0 : 5.2);
  return structure.height_m.value_or(by_kind);
}

struct Materials {
  int concrete, smooth, paint;
};

class Mason {
 public:
  Mason(const StructureOptions& structure, const StreetFrame& street, const Materials& materials,
        std::uint64_t seed, SceneBuilder& scene)
      : structure_(structure),
        street_(street),
        materials_(materials),
        scene_(scene),
        stains_(seed, 3.0),
        height_m_(HeightOf(structure)) {}

  void BuildWalls() {
    const double edge = street_.half_road_m() - kBeforeKerb_m;
    for (const double side : {1.0, -1.0}) {
      WallAlong(side, edge, height_m_, materials_.smooth, 0.04, false);
      Face({{side * edge, height_m_}, {side * (edge + kWallThickness_m), height_m_}}, side < 0.0,
           materials_.smooth, 0.04, false);
      WallAlong(-side, -(edge + kWallThickness_m), height_m_, materials_.concrete, 0.2, false);
      for (const double s : Ends()) EndOfWall(s, side, edge, height_m_);
    }
  }

  void BuildTunnel() {
    const double edge = street_.half_road_m() + kBehindKerb_m;
    const double roof = height_m_ + 0.6;
    for (const double side : {1.0, -1.0}) {
      WallAlong(side, edge, height_m_, materials_.concrete, 0.2, true);
      WallAlong(-side, -(edge + kWallThickness_m), roof, materials_.concrete, 0.25, false);
      for (const double s : Ends()) EndOfWall(s, side, edge, height_m_);
    }
    // The ceiling looks down: from left to right.
    Face({{edge, height_m_}, {1.5, height_m_}, {-1.5, height_m_}, {-edge, height_m_}}, false,
         materials_.concrete, 0.2, true);
    const double out = edge + kWallThickness_m;
    Face({{-out, roof}, {out, roof}}, false, materials_.concrete, 0.25, false);
    for (const double s : Ends()) Lintel(s, out, roof);
    AddLamps(edge);
  }

  // A straight deck across the road on piers and end walls.
  void BuildBridge() {
    const double left = street_.half_road_m() + kKerbWidth_m + kInnerPath_m + 3.0;
    const double right = -street_.half_road_m() - kBayWidth_m - kOuterPavement_m - 1.0;
    const double middle = structure_.start_m + 0.5 * structure_.length_m;
    const double yaw = street_.Yaw(middle);
    const Vector3d up = Vector3d::UnitZ();
    const Vector3d along(std::cos(yaw), std::sin(yaw), 0.0);
    const Vector3d across(-along.y(), along.x(), 0.0);
    const double width = structure_.length_m;
    const double span = left - right;
    const double below = HighestGround() + height_m_;
    Vector3d center = street_.At(middle, 0.5 * (left + right));
    center.z() = below;
    constexpr double kDeck_m = 0.9;
    Slab({center, yaw, width, span, kDeck_m}, 0.45);
    for (const double side : {-1.0, 1.0}) {
      const Vector3d edge = center + side * (0.5 * width - 0.15) * along + kDeck_m * up;
      scene_.AddBox({edge, yaw, 0.25, span, 0.9}, materials_.concrete, 0.4, 1.0);
      scene_.AddBox({edge + 0.9 * up, yaw, 0.35, span, 0.12}, materials_.paint, 0.4, 0.5);
      const Vector3d end = center + side * (0.5 * span - 0.6) * across - (height_m_ + 1.5) * up;
      scene_.AddBox({end, yaw, width, 1.2, height_m_ + 1.5}, materials_.concrete, 0.4, 0.9);
      AddPiers(middle + side * (0.5 * width - 0.75), below);
    }
  }

 private:
  // The road bends below a straight deck: its own edges say where piers can stand.
  void AddPiers(double s, double head_z) {
    for (const double at :
         {street_.half_road_m() + 0.75, -street_.half_road_m() - kBayWidth_m - 0.75}) {
      const Vector3d foot = street_.At(s, at, -1.0);
      scene_.AddPole({foot, {foot.x(), foot.y(), head_z}, 0.4, 0.4, 10}, materials_.concrete, 0.4,
                     0.85);
    }
  }

  // Of the road below.
  [[nodiscard]] double HighestGround() const {
    double highest = -std::numeric_limits<double>::infinity();
    for (double along = 0.0; along <= 1.0; along += 0.125) {
      for (const double offset : {-street_.half_road_m(), 0.0, street_.half_road_m()}) {
        const double s = structure_.start_m + along * structure_.length_m;
        highest = std::max(highest, street_.At(s, offset).z());
      }
    }
    return highest;
  }

  [[nodiscard]] std::array<double, 2> Ends() const {
    return {structure_.start_m, structure_.start_m + structure_.length_m};
  }

  // Pieces that can be culled, of quads some two metres long. reversed: the other side is drawn.
  void Face(std::vector<Rib> ribs, bool reversed, int texture, double contrast, bool is_inside) {
    if (reversed) std::reverse(ribs.begin(), ribs.end());
    const int pieces = std::max(1, static_cast<int>(structure_.length_m / 24.0));
    const double piece = structure_.length_m / pieces;
    std::vector<double> at_m = {0.0};  // along the section
    for (std::size_t i = 1; i < ribs.size(); ++i) {
      at_m.push_back(at_m.back() + std::hypot(ribs[i].offset_m - ribs[i - 1].offset_m,
                                              ribs[i].lift_m - ribs[i - 1].lift_m));
    }
    for (int i = 0; i < pieces; ++i) {
      const double s0 = structure_.start_m + piece * i;
      AddSweep(
          street_, {s0, s0 + piece, std::max(1, static_cast<int>(piece / 1.6)), ribs, texture},
          [&](double along, int rib, const Vector3d&) -> Vector2d {
            return {(s0 + along * piece) / 6.0, at_m[static_cast<std::size_t>(rib)] / 6.0};
          },
          [&](double s, const Rib&, const Vector3d& p) {
            const double stain = 1.0 + contrast * stains_.At(p.x() + p.y(), 2.0 * p.z());
            return stain * (is_inside ? DaylightAt({structure_}, s, street_) : 1.0);
          },
          scene_);
    }
  }

  // The face at side * edge that looks towards the road's middle for a positive edge.
  void WallAlong(double side, double edge, double height, int texture, double contrast,
                 bool is_inside) {
    Face({{side * edge, -0.1}, {side * edge, 0.45 * height}, {side * edge, height}}, side < 0.0,
         texture, contrast, is_inside);
  }

  // The narrow ends of a wall, drawn from both sides: one of them is never seen.
  void EndOfWall(double s, double side, double edge, double height) {
    const Vector3d foot = street_.At(s, side * (edge + 0.5 * kWallThickness_m), -0.1);
    scene_.AddBox({foot, street_.Yaw(s), 0.06, kWallThickness_m + 0.02, height + 0.1},
                  materials_.concrete, 0.3, 0.9);
  }

  // Above the mouth of a tunnel.
  void Lintel(double s, double out, double roof) {
    const Vector3d middle = street_.At(s, 0.0);
    Slab({{middle.x(), middle.y(), middle.z() + height_m_ - 0.1},
          street_.Yaw(s),
          0.4,
          2.0 * out + 0.6,
          roof - height_m_ + 0.7},
         0.7);
  }

  // A box with an underside.
  void Slab(const Box& box, double shade_below) {
    scene_.AddBox(box, materials_.concrete, 0.3, 1.0);
    const Vector3d along(std::cos(box.yaw_rad), std::sin(box.yaw_rad), 0.0);
    const Vector3d across(-along.y(), along.x(), 0.0);
    const Vector3d corner = box.foot_m - 0.5 * box.length_m * along - 0.5 * box.width_m * across;
    // Right cross up of this wall points down.
    RandomStream::Sample random = RandomStream(1, 0, "world/structures/slab").At(0);
    scene_.AddWall({corner, box.width_m * across, box.length_m * along,
                    std::max(1, static_cast<int>(box.width_m / 2.0)),
                    std::max(1, static_cast<int>(box.length_m / 2.0))},
                   materials_.concrete, {0.0, 0.0, box.width_m / 5.0, box.length_m / 5.0},
                   shade_below, 0.15, random);
  }

  // Strips of light below the ceiling, brighter than any reflectance.
  void AddLamps(double edge) {
    const int lamps = static_cast<int>(structure_.length_m / kLampSpacing_m);
    for (int i = 0; i <= lamps; ++i) {
      const double s = structure_.start_m + kLampSpacing_m * i;
      if (DepthIn(structure_, s, street_.length_m()) < 2.0) continue;
      for (const double side : {-1.0, 1.0}) {
        const double offset = side * (edge - 0.9);
        Vector3d foot = street_.At(s, offset, height_m_ - 0.12);
        Slab({foot, street_.Yaw(s), 1.6, 0.25, 0.1}, 3.0);
      }
    }
  }

  const StructureOptions& structure_;
  const StreetFrame& street_;
  const Materials& materials_;
  SceneBuilder& scene_;
  GroundNoise stains_;
  double height_m_;
};

}  // namespace

void AddStructures(const std::vector<StructureOptions>& structures, const StreetFrame& street,
                   std::uint64_t seed, SceneBuilder& scene) {
  if (structures.empty()) return;
  const RandomStream stream(seed, 0, "world/structures");
  Sample random = stream.At(0);
  const Materials materials{
      .concrete = scene.AddTexture([&] { return PavingTexture(4, 0.8, random); }),
      .smooth = scene.AddTexture([&] { return PlainTexture(512, 105.0, 0.04, random); }, kPlain),
      .paint = scene.AddTexture([&] { return PlainTexture(256, 170.0, 0.25, random); })};
  for (std::size_t i = 0; i < structures.size(); ++i) {
    const StructureOptions& structure = structures[i];
    scene.SetLabel(structure.kind == "canopy" ? Label::kVegetation : Label::kStructure);
    Mason mason(structure, street, materials, seed + i, scene);
    if (structure.kind == "bridge") mason.BuildBridge();
    if (structure.kind == "tunnel") mason.BuildTunnel();
    if (structure.kind == "plain_wall") mason.BuildWalls();
    if (structure.kind == "canopy") {
      AddCanopy({structure.start_m, structure.length_m, HeightOf(structure), structure.density},
                street, RandomStream(seed, i, "world/structures/canopy"), scene);
    }
  }
}

}  // namespace polnav::sim
