#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "sim/world/actor_models.h"
#include "sim/world/actor_textures.h"

namespace polnav::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Half a cross section of a body: sill, belt line, edge of the roof.
struct Section {
  double x_m;
  double sill_y_m, sill_z_m;
  double belt_y_m, belt_z_m;
  double top_y_m, top_z_m;
};

struct Size {
  double length_m, width_m, height_m;
};

// A body between sections from back to front, with flat facets, painted from an atlas.
class Body {
 public:
  Body(const Size& size, Mesh& mesh) : size_(size), mesh_(mesh) {}

  void Add(const std::vector<Section>& sections) {
    for (std::size_t i = 0; i + 1 < sections.size(); ++i) AddBay(sections[i], sections[i + 1]);
    AddEnd(sections.back(), kFrontView, 1.0);
    AddEnd(sections.front(), kBackView, -1.0);
  }

 private:
  void AddBay(const Section& a, const Section& b) {
    for (const double side : {1.0, -1.0}) {
      const AtlasView& view = side > 0.0 ? kLeftView : kRightView;
      AddQuad({Sill(a, side), Sill(b, side), Belt(b, side), Belt(a, side)}, view, -side);
      AddQuad({Belt(a, side), Belt(b, side), Top(b, side), Top(a, side)}, view, -side);
    }
    // What is steep belongs to the front or the back.
    const bool steep = std::abs(b.top_z_m - a.top_z_m) > b.x_m - a.x_m;
    const AtlasView& above = !steep ? kTopView : (a.x_m < 0.0 ? kBackView : kFrontView);
    AddQuad({Top(a, 1.0), Top(b, 1.0), Top(b, -1.0), Top(a, -1.0)}, above, -1.0);
    AddQuad({Sill(a, 1.0), Sill(b, 1.0), Sill(b, -1.0), Sill(a, -1.0)}, kTopView, 1.0, 0.1);
  }
  void AddEnd(const Section& s, const AtlasView& view, double turn) {
    AddQuad({Sill(s, 1.0), Sill(s, -1.0), Belt(s, -1.0), Belt(s, 1.0)}, view, -turn);
    AddQuad({Belt(s, 1.0), Belt(s, -1.0), Top(s, -1.0), Top(s, 1.0)}, view, -turn);
  }

  static Vector3d Sill(const Section& s, double side) {
    return {s.x_m, side * s.sill_y_m, s.sill_z_m};
  }
  static Vector3d Belt(const Section& s, double side) {
    return {s.x_m, side * s.belt_y_m, s.belt_z_m};
  }
  static Vector3d Top(const Section& s, double side) {
    return {s.x_m, side * s.top_y_m, s.top_z_m};
  }

  // Shares of the vehicle's size, seen from that side; v runs down.
  [[nodiscard]] Vector2d Uv(const Vector3d& p, const AtlasView& view) const {
    const bool end = view.v == kFrontView.v;
    const double along = p.x() / size_.length_m + 0.5;
    const double across = 0.5 - p.y() / size_.width_m;
    const double down = 1.0 - p.z() / size_.height_m;
    const bool from_above = view.v == kTopView.v;
    return {view.u + view.width * (end ? across : along),
            view.v + view.height * (from_above ? across : down)};
  }

  // turn: +1 when the corners run counter-clockwise seen from outside.
  void AddQuad(const std::array<Vector3d, 4>& corners, const AtlasView& view, double turn,
               float shade = 1.0F) {
    const Vector3d across = (corners[2] - corners[0]).cross(corners[3] - corners[1]);
    if (across.norm() < 1e-9) return;
    const Vector3d normal = turn * across.normalized();
    const auto a = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (const Vector3d& p : corners) {
      mesh_.vertices.push_back(
          {p.cast<float>(), normal.cast<float>(), Uv(p, view).cast<float>(), shade});
    }
    if (turn > 0.0) {
      mesh_.indices.insert(mesh_.indices.end(), {a, a + 1, a + 2, a, a + 2, a + 3});
    } else {
      mesh_.indices.insert(mesh_.indices.end(), {a, a + 2, a + 1, a, a + 3, a + 2});
    }
  }

  Size size_;
  Mesh& mesh_;
};

std::vector<Section> CarSections(const CarShape& shape) {
  const double half = 0.5 * shape.width_m;
  const double belt = shape.top[2].z_m;
  std::vector<Section> sections;
  for (std::size_t i = 0; i < shape.top.size(); ++i) {
    const Profile& top = shape.top[i];
    const bool end = i == 0 || i + 1 == shape.top.size();
    const double y = end ? 0.90 * half : half;
    const double above = std::max(0.0, top.z_m - belt);
    const double belt_z = std::min(belt, top.z_m - 0.05);
    sections.push_back({top.x_m - 0.5 * shape.length_m, 0.95 * y, end ? 0.30 : 0.20, y, belt_z,
                        y - 0.05 - 0.42 * above, top.z_m});
  }
  return sections;
}

void AddWheels(const std::vector<double>& axles_x_m, double half_width_m, double radius_m,
               int paint, SceneBuilder& builder) {
  builder.SetDetail(false);
  for (const double x : axles_x_m) {
    for (const double side : {-1.0, 1.0}) {
      const Vector3d hub(x, side * (half_width_m - 0.20), radius_m);
      const Vector3d axle = side * Vector3d::UnitY();
      builder.AddPole({hub, hub + 0.21 * axle, radius_m, radius_m, 12, true}, paint, 0.8, 0.10);
      builder.AddPole({hub, hub + 0.22 * axle, 0.62 * radius_m, 0.58 * radius_m, 8, true}, paint,
                      0.8, 0.62);
    }
  }
}

SceneBuilder OwnFrame() {
  SceneBuilder builder(std::numeric_limits<double>::infinity());
  builder.SetLabel(Label::kVehicle);
  return builder;
}

}  // namespace

std::vector<Mesh> CarMeshes(const ActorTextures& textures, RandomStream::Sample& random) {
  const auto which = static_cast<std::size_t>(random.Bits() % textures.cars.size());
  const CarShape shape = std::array{Saloon(), Hatchback(), OffRoader()}[which % 3];
  SceneBuilder builder = OwnFrame();
  Body({shape.length_m, shape.width_m, shape.height_m},
       builder.MeshAt(Vector3d::Zero(), textures.cars[which]))
      .Add(CarSections(shape));
  const double middle = 0.5 * shape.length_m;
  AddWheels({shape.rear_wheel_m - middle, shape.front_wheel_m - middle}, 0.5 * shape.width_m,
            shape.wheel_radius_m, textures.paint, builder);
  for (const double side : {-1.0, 1.0}) {  // mirrors
    const Vector3d foot(shape.top[5].x_m - middle - 0.35, side * (0.5 * shape.width_m + 0.08),
                        shape.top[2].z_m);
    builder.AddBox({foot, 0.0, 0.10, 0.20, 0.14}, textures.paint, 0.8, 0.3);
  }
  return builder.Take().meshes;
}

std::vector<Mesh> BusMeshes(const ActorTextures& textures) {
  const double half = 0.5 * kBusWidth_m;
  const double end = 0.5 * kBusLength_m;
  const double top = kBusHeight_m;
  const auto section = [&](double x, double narrow, double low) {
    const double y = half - narrow;
    return Section{x, y - 0.03, 0.30, y, top - 0.25 - low, y - 0.22, top - low};
  };
  SceneBuilder builder = OwnFrame();
  Body({kBusLength_m, kBusWidth_m, kBusHeight_m}, builder.MeshAt(Vector3d::Zero(), textures.bus))
      .Add({section(-end, 0.10, 0.08), section(-end + 0.2, 0.0, 0.0), section(0.0, 0.0, 0.0),
            section(end - 0.35, 0.0, 0.0), section(end, 0.16, 0.14)});
  AddWheels({2.9 - end, 9.2 - end}, half, 0.5, textures.paint, builder);
  for (const double side : {-1.0, 1.0}) {
    builder.AddBox({{end + 0.15, side * (half + 0.10), 2.0}, 0.0, 0.12, 0.28, 0.5}, textures.paint,
                   0.8, 0.15);
  }
  builder.AddBox({{-1.2, 0.0, top - 0.02}, 0.0, 2.8, 1.6, 0.25, 0.9}, textures.paint, 0.8, 0.7);
  return builder.Take().meshes;
}

Actor MakeCar(std::string name, std::vector<ActorKey> path, const ActorTextures& textures,
              RandomStream::Sample& random) {
  return {std::move(name), CarMeshes(textures, random), std::move(path)};
}

Actor MakeBus(std::string name, std::vector<ActorKey> path, const ActorTextures& textures) {
  return {std::move(name), BusMeshes(textures), std::move(path)};
}

}  // namespace polnav::sim
