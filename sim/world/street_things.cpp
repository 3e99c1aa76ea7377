#include "sim/world/street_things.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sim/world/facade_textures.h"
#include "sim/world/textures.h"

namespace polnav::sim {
namespace {

using Eigen::Vector3d;

struct Materials {
  int paint = 0;  // white with dirt: shades make it any grey
  int wood = 0;
  int hedge = 0;
  int poster = 0;
};

void AddLamp(const StreetFrame& street, double s, const Materials& materials, SceneBuilder& scene) {
  const double offset = -street.half_road_m() - kBayWidth_m - 0.8;
  const Vector3d foot = street.At(s, offset, kKerbHeight_m);
  const Vector3d top = foot + Vector3d(0.0, 0.0, 7.5);
  const Vector3d arm = street.At(s, offset - 1.4, 0.0) - street.At(s, offset, 0.0);
  scene.AddPole({foot, foot + Vector3d(0, 0, 1.0), 0.16, 0.14, 8}, materials.paint, 0.5, 0.35);
  scene.AddPole({foot + Vector3d(0, 0, 1.0), top, 0.09, 0.06, 8}, materials.paint, 0.5, 0.5);
  scene.AddPole({top, top + arm, 0.05, 0.04, 6}, materials.paint, 0.5, 0.5);
  scene.AddBox({top + arm, street.Yaw(s) + M_PI_2, 0.7, 0.3, 0.12}, materials.paint, 0.5, 0.8);
}

void AddParkedCar(const StreetFrame& street, double s, const ActorTextures& textures,
                  Sample& random, SceneBuilder& scene) {
  const double offset = -street.half_road_m() - 0.5 * kBayWidth_m - 0.1;
  const double yaw = street.Yaw(s) + 0.02 * random.Gaussian();
  scene.AddModel(
      CarMeshes(textures, random),
      {Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Vector3d::UnitZ())), street.At(s, offset, 0.0)});
  scene.SetLabel(Label::kStreetThing);
}

void AddBench(const Vector3d& foot, double yaw, const Materials& materials, SceneBuilder& scene) {
  const Vector3d across(-std::sin(yaw), std::cos(yaw), 0.0);
  const Vector3d along(std::cos(yaw), std::sin(yaw), 0.0);
  scene.AddBox({foot + 0.42 * Vector3d::UnitZ(), yaw, 1.8, 0.45, 0.07}, materials.wood, 0.6, 1.0);
  scene.AddBox({foot + 0.22 * across + 0.49 * Vector3d::UnitZ(), yaw, 1.8, 0.06, 0.42},
               materials.wood, 0.6, 0.9);
  scene.SetDetail(true);
  for (const double x : {-0.75, 0.75}) {
    scene.AddBox({foot + x * along, yaw, 0.08, 0.42, 0.42}, materials.paint, 0.6, 0.3);
  }
  scene.SetDetail(false);
}

// A clipped row of bushes: a core, and lumps that break its outline.
void AddHedge(const Vector3d& foot, double yaw, const Materials& materials, Sample& random,
              SceneBuilder& scene) {
  const double length = 3.0 + 5.0 * random.Uniform();
  const double height = 0.7 + 0.4 * random.Uniform();
  const Vector3d along(std::cos(yaw), std::sin(yaw), 0.0);
  scene.SetLabel(Label::kVegetation);
  scene.AddBox({foot, yaw, length, 0.7, 0.85 * height, 0.92}, materials.hedge, 0.5, 0.9);
  const int bushes = static_cast<int>(length / 0.9);
  for (int i = 0; i < bushes; ++i) {
    const Vector3d at = foot + length * ((i + 0.5) / bushes - 0.5) * along;
    scene.AddBlob(at + 0.55 * height * Vector3d::UnitZ(), {0.55, 0.5, 0.6 * height},
                  materials.hedge, 0.9 + 0.4 * random.Uniform(), random);
  }
  scene.SetLabel(Label::kStreetThing);
}

void AddSign(const Vector3d& foot, double yaw, const Materials& materials, Sample& random,
             SceneBuilder& scene) {
  const double height = 1.6 + 1.2 * random.Uniform();
  const Vector3d top = foot + height * Vector3d::UnitZ();
  scene.AddPole({foot, top, 0.05, 0.05, 6}, materials.paint, 0.6, 0.6);
  scene.AddBox(
      {top, yaw + M_PI_2, 0.8 + 0.8 * random.Uniform(), 0.08, 0.6 + 0.6 * random.Uniform()},
      materials.poster, 0.35, 1.0);
}

void AddPiece(int kind, const Vector3d& foot, double yaw, const Materials& materials,
              Sample& random, SceneBuilder& scene) {
  switch (kind % 5) {
    case 0:
      AddBench(foot, yaw, materials, scene);
      break;
    case 1:
      scene.AddBox({foot, yaw, 0.5, 0.45, 0.9, 0.9}, materials.paint, 0.7, 0.4);
      break;
    case 2:
      AddHedge(foot, yaw, materials, random, scene);
      break;
    case 3:
      AddSign(foot, yaw, materials, random, scene);
      break;
    default:  // planter
      scene.AddBox({foot, yaw, 1.2, 1.2, 0.55, 1.15}, materials.wood, 0.6, 1.2);
      scene.AddBlob(foot + 0.8 * Vector3d::UnitZ(), {0.6, 0.6, 0.5}, materials.hedge, 1.1, random);
  }
}

// The landmark in the middle of the park.
void AddMonument(const StreetFrame& street, const Materials& materials, SceneBuilder& scene) {
  const Vector3d foot = street.OnGround(street.center_m(), kKerbHeight_m);
  const Vector3d up = Vector3d::UnitZ();
  scene.AddBox({foot, 0.3, 9.0, 9.0, 0.5}, materials.wood, 0.4, 1.2);
  scene.AddBox({foot + 0.5 * up, 0.3, 6.0, 6.0, 0.5}, materials.wood, 0.4, 1.1);
  scene.AddBox({foot + 1.0 * up, 0.3, 3.0, 3.0, 2.5, 0.9}, materials.poster, 0.2, 1.0);
  scene.AddPole({foot + 3.5 * up, foot + 14.0 * up, 0.9, 0.4, 10}, materials.wood, 0.4, 1.3);
}

}  // namespace

void AddStreetThings(const PlazaOptions& options, const StreetFrame& street,
                     const ActorTextures& textures, std::uint64_t seed, SceneBuilder& scene) {
  scene.SetLabel(Label::kStreetThing);
  const RandomStream stream(seed, 0, "plaza/things");
  Sample texture_random = stream.At(0);
  const Materials materials{
      .paint = scene.AddTexture([&] { return PlainTexture(256, 170.0, 0.25, texture_random); }),
      .wood = scene.AddTexture([&] { return PlainTexture(256, 95.0, 0.6, texture_random); }),
      .hedge = scene.AddTexture([&] { return FoliageTexture(texture_random); }),
      .poster = scene.AddTexture([&] { return ShopTexture(texture_random); })};
  for (int i = 0; i < options.lamp_count; ++i) {
    AddLamp(street, street.length_m() * (i + 0.5) / options.lamp_count, materials, scene);
  }
  for (int i = 0; i < options.parked_car_count; ++i) {
    Sample random = stream.At(static_cast<std::uint64_t>(i) + 1000);
    const double slot = street.length_m() / options.parked_car_count;
    AddParkedCar(street, slot * (i + 0.3 + 0.4 * random.Uniform()), textures, random, scene);
  }
  for (int i = 0; i < options.furniture_count; ++i) {
    Sample random = stream.At(static_cast<std::uint64_t>(i) + 2000);
    const double s = street.length_m() * (i + random.Uniform()) / options.furniture_count;
    const double inner =
        street.half_road_m() + kKerbWidth_m + kInnerPath_m + 6.0 * random.Uniform();
    // People walk between the lamps and these.
    const double outer = -street.half_road_m() - kBayWidth_m - 2.8 - 3.7 * random.Uniform();
    const double offset = i % 2 == 0 ? inner : outer;
    const double yaw = street.Yaw(s) + 0.1 * random.Gaussian();
    AddPiece(static_cast<int>(random.Bits() % 5), street.At(s, offset, kKerbHeight_m), yaw,
             materials, random, scene);
  }
  AddMonument(street, materials, scene);
}

}  // namespace polnav::sim
