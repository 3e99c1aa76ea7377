#include "sim/world/houses.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/world/facade_textures.h"
#include "sim/world/textures.h"

namespace polnav::sim {
namespace {

using Eigen::Vector3d;

constexpr int kStyles = 10;
constexpr int kShopStyles = 3;

struct HouseTextures {
  std::vector<int> facades;
  std::vector<int> shops;
  int concrete = 0;
};

struct House {
  Vector3d foot_m;  // middle of the front, at the ground
  double yaw_rad;   // of the front, left to right as seen from the road
  int bays;
  int storeys;
  double depth_m;
  int style;
  int shop_style;
  double shade;
};

HouseTextures MakeTextures(const RandomStream& stream, SceneBuilder& scene) {
  HouseTextures textures;
  for (int i = 0; i < kStyles; ++i) {
    Sample random = stream.At(static_cast<std::uint64_t>(i));
    textures.facades.push_back(scene.AddTexture([&] { return FacadeTexture(i, random); }));
  }
  for (int i = 0; i < kShopStyles; ++i) {
    Sample random = stream.At(static_cast<std::uint64_t>(kStyles + i));
    textures.shops.push_back(scene.AddTexture([&] { return ShopTexture(random); }));
  }
  Sample random = stream.At(kStyles + kShopStyles);
  textures.concrete = scene.AddTexture([&] { return PlainTexture(256, 120.0, 0.35, random); });
  return textures;
}

// One side from the ground to the roof: shops below, storeys above.
void AddSide(const House& house, const Vector3d& corner, const Vector3d& right, int bays,
             bool has_shops, const HouseTextures& textures, Sample& random, SceneBuilder& scene) {
  const double per_texture = 1.0 / kBaysPerTexture;
  const double first_bay = static_cast<double>(random.Bits() % 4) * per_texture;
  const double width = bays * per_texture;
  const Vector3d storey = kBay_m * Vector3d::UnitZ();
  const int facade = textures.facades[static_cast<std::size_t>(house.style)];
  // The front's shade varies from bay to bay; the other sides are seldom seen.
  const int columns = has_shops ? (bays + 1) / 2 : 1;
  const Wall ground{corner, right, storey, columns, 1};
  if (has_shops) {
    const int shop = textures.shops[static_cast<std::size_t>(house.shop_style)];
    scene.AddWall(ground, shop, {first_bay, 0.0, width, 1.0}, house.shade, 0.15, random);
  } else {
    scene.AddWall(ground, facade, {first_bay, 0.75, width, per_texture}, house.shade, 0.2, random);
  }
  const int upper = house.storeys - 1;
  const Wall storeys{corner + storey, right, upper * storey, columns,
                     has_shops ? (upper + 1) / 2 : 1};
  scene.AddWall(storeys, facade,
                {first_bay, (house.storeys % 4) * per_texture, width, upper * per_texture},
                house.shade, 0.2, random);
  // What the wall stands on, where the ground falls away.
  const Wall plinth{corner - 2.0 * Vector3d::UnitZ(), right, 2.0 * Vector3d::UnitZ(), 1, 1};
  scene.AddWall(plinth, textures.concrete, {0.0, 0.0, bays * 0.8, 0.5}, 0.7, 0.1, random);
}

void AddBalconies(const House& house, const Vector3d& right, const Vector3d& front,
                  const HouseTextures& textures, Sample& random, SceneBuilder& scene) {
  if (random.Uniform() < 0.3) return;
  const auto column_of_balconies = static_cast<int>(random.Bits() % 2);
  for (int storey = 1; storey < house.storeys; ++storey) {
    for (int bay = column_of_balconies; bay < house.bays; bay += 2) {
      if (random.Uniform() < 0.35) continue;
      const double x = kBay_m * (bay + 0.5 - 0.5 * house.bays);
      const Vector3d foot =
          house.foot_m + x * right + 0.55 * front + (kBay_m * storey - 0.15) * Vector3d::UnitZ();
      const double shade = 0.6 + 0.8 * random.Uniform();
      scene.AddBox({foot, house.yaw_rad, 2.4, 1.1, 1.05}, textures.concrete, 0.4, shade);
    }
  }
}

void AddHouse(const House& house, const HouseTextures& textures, Sample& random,
              SceneBuilder& scene) {
  const Vector3d right(std::cos(house.yaw_rad), std::sin(house.yaw_rad), 0.0);
  const Vector3d front = right.cross(Vector3d::UnitZ());
  const double width = kBay_m * house.bays;
  const double height = kBay_m * house.storeys;
  const int side_bays = std::max(2, static_cast<int>(house.depth_m / kBay_m));
  const double depth = kBay_m * side_bays;
  const Vector3d left_corner = house.foot_m - 0.5 * width * right;
  const Vector3d right_corner = house.foot_m + 0.5 * width * right;
  AddSide(house, left_corner, width * right, house.bays, true, textures, random, scene);
  AddSide(house, right_corner, -depth * front, side_bays, false, textures, random, scene);
  AddSide(house, left_corner - depth * front, depth * front, side_bays, false, textures, random,
          scene);
  if (house.storeys < 8) AddBalconies(house, right, front, textures, random, scene);
  const Vector3d middle = house.foot_m - 0.5 * depth * front;
  const Vector3d roof = middle + height * Vector3d::UnitZ();
  scene.AddBox({roof, house.yaw_rad, width + 0.8, depth + 0.8, 0.7}, textures.concrete, 0.4, 0.9);
  const int boxes = 1 + static_cast<int>(random.Bits() % 3);  // stairs, tanks, lifts
  for (int i = 0; i < boxes; ++i) {
    const Vector3d foot = roof + (random.Uniform() - 0.5) * 0.7 * width * right +
                          (random.Uniform() - 0.5) * 0.5 * depth * front;
    scene.AddBox(
        {foot, house.yaw_rad, 2.0 + 3.0 * random.Uniform(), 3.0, 2.0 + 2.0 * random.Uniform()},
        textures.concrete, 0.3, 0.6 + 0.6 * random.Uniform());
  }
}

House DrawHouse(double mean_height_m, Sample& random) {
  House house{};
  house.bays = 3 + static_cast<int>(random.Bits() % 6);
  const double mean = mean_height_m / kBay_m;
  house.storeys = std::max(2, static_cast<int>(std::lround(mean * (0.5 + random.Uniform()))));
  house.depth_m = 8.0 + 6.0 * random.Uniform();
  house.style = static_cast<int>(random.Bits() % kStyles);
  house.shop_style = static_cast<int>(random.Bits() % kShopStyles);
  house.shade = 0.75 + 0.5 * random.Uniform();
  return house;
}

// A row around the plaza, wall to wall with some gaps.
void AddRow(const PlazaOptions& options, const StreetFrame& street, const HouseTextures& textures,
            Sample& random, SceneBuilder& scene) {
  double s = 0.0;
  while (true) {
    House house = DrawHouse(options.facade_height_m, random);
    const double set_back = 14.0 * random.Uniform() * random.Uniform();
    const double offset = -street.half_road_m() - options.facade_distance_m - set_back;
    const double gap = random.Uniform() < 0.2 ? 9.0 : 1.5 * random.Uniform();
    // Arc length on the road that the front takes up at its distance from the centre.
    const double shrink = street.radius_m() / (street.radius_m() - offset);
    const double span = (kBay_m * house.bays + gap) * shrink;
    if (s + span > street.length_m()) return;
    const double middle = s + 0.5 * span;
    house.foot_m = street.At(middle, offset, kKerbHeight_m);
    // Seen from the road, right is against the driving direction.
    house.yaw_rad = street.Yaw(middle) + M_PI + 0.03 * random.Gaussian();
    AddHouse(house, textures, random, scene);
    s += span;
  }
}

// Towers further out close the view between the houses.
void AddTowers(const StreetFrame& street, const HouseTextures& textures, Sample& random,
               SceneBuilder& scene) {
  constexpr int kTowers = 22;
  for (int i = 0; i < kTowers; ++i) {
    const double at = street.length_m() * (i + 0.6 * random.Uniform()) / kTowers;
    const House tower{.foot_m = street.At(at, -75.0 - 60.0 * random.Uniform(), 0.0),
                      .yaw_rad = street.Yaw(at) + M_PI + 0.2 * random.Gaussian(),
                      .bays = 5 + static_cast<int>(random.Bits() % 5),
                      .storeys = 8 + static_cast<int>(random.Bits() % 9),
                      .depth_m = 14.0,
                      .style = static_cast<int>(random.Bits() % kStyles),
                      .shop_style = 0,
                      .shade = 0.8 + 0.4 * random.Uniform()};
    AddHouse(tower, textures, random, scene);
  }
}

}  // namespace

void AddHouses(const PlazaOptions& options, const StreetFrame& street, std::uint64_t seed,
               SceneBuilder& scene) {
  scene.SetLabel(Label::kBuilding);
  const RandomStream stream(seed, 0, "plaza/houses");
  const HouseTextures textures = MakeTextures(stream, scene);
  Sample random = stream.At(1000);
  AddRow(options, street, textures, random, scene);
  AddTowers(street, textures, random, scene);
}

}  // namespace polnav::sim
