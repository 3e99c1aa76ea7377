#include "sim/world/scene_builder.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>

namespace polnav::sim {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr float kDetailDistance_m = 45.0F;

Vertex MakeVertex(const Vector3d& p, const Vector3d& normal, double u, double v, double shade) {
  return {p.cast<float>(), normal.cast<float>(),
          Eigen::Vector2f(static_cast<float>(u), static_cast<float>(v)), static_cast<float>(shade)};
}

// Two triangles of four vertices that run counter-clockwise.
void AddQuadIndices(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c,
                    std::uint32_t d) {
  mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
}

}  // namespace

int SceneBuilder::AddTexture(const std::function<cv::Mat()>& draw, double detail) {
  return AddTexture(draws_ ? draw() : cv::Mat(1, 1, CV_8UC1, cv::Scalar(255)), detail);
}

int SceneBuilder::AddTexture(const cv::Mat& reflectance, double detail) {
  scene_.textures.push_back(reflectance);
  scene_.detail.push_back(detail);
  return static_cast<int>(scene_.textures.size()) - 1;
}

Mesh& SceneBuilder::MeshAt(const Vector3d& p_m, int texture) {
  const Cell cell{static_cast<int>(std::floor(p_m.x() / cell_m_)),
                  static_cast<int>(std::floor(p_m.y() / cell_m_)),
                  texture,
                  is_detail_,
                  label_,
                  cover_};
  const auto [entry, is_new] = mesh_of_cell_.try_emplace(cell, scene_.meshes.size());
  if (is_new) {
    scene_.meshes.push_back({.texture = texture, .label = label_, .cover = cover_});
    if (is_detail_) scene_.meshes.back().draw_distance_m = kDetailDistance_m;
  }
  return scene_.meshes[entry->second];
}

void SceneBuilder::CapPole(Mesh& mesh, const Pole& pole, std::uint32_t first, double uv_per_m,
                           double shade) {
  const Vector3d normal = (pole.top_m - pole.foot_m).normalized();
  const auto center = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(MakeVertex(pole.top_m, normal, 0.0, 0.0, shade));
  for (int i = 0; i <= pole.sides; ++i) {
    Vertex rim = mesh.vertices[first + 2 * static_cast<std::uint32_t>(i) + 1];
    const double around = 2.0 * pi * i / pole.sides;
    rim.normal_W = normal.cast<float>();
    rim.uv = (uv_per_m * pole.top_radius_m * Eigen::Vector2d(std::cos(around), std::sin(around)))
                 .cast<float>();
    mesh.vertices.push_back(rim);
    const auto a = center + 1 + static_cast<std::uint32_t>(i);
    if (i < pole.sides) mesh.indices.insert(mesh.indices.end(), {center, a, a + 1});
  }
}

void SceneBuilder::AddWall(const Wall& wall, int texture, const UvRect& uv, double shade,
                           double shade_spread, RandomStream::Sample& random) {
  Mesh& mesh = MeshAt(wall.corner_m + 0.5 * wall.right_m, texture);
  const Vector3d normal = wall.right_m.cross(wall.up_m).normalized();
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int row = 0; row <= wall.rows; ++row) {
    for (int column = 0; column <= wall.columns; ++column) {
      const double a = static_cast<double>(column) / wall.columns;
      const double b = static_cast<double>(row) / wall.rows;
      const double here = shade * (1.0 + shade_spread * (2.0 * random.Uniform() - 1.0));
      mesh.vertices.push_back(MakeVertex(wall.corner_m + a * wall.right_m + b * wall.up_m, normal,
                                         uv.u + a * uv.width, uv.v + (1.0 - b) * uv.height, here));
    }
  }
  const auto stride = static_cast<std::uint32_t>(wall.columns) + 1;
  for (int row = 0; row < wall.rows; ++row) {
    for (int column = 0; column < wall.columns; ++column) {
      const std::uint32_t a =
          first + static_cast<std::uint32_t>(row) * stride + static_cast<std::uint32_t>(column);
      AddQuadIndices(mesh, a, a + 1, a + stride + 1, a + stride);
    }
  }
}

void SceneBuilder::AddFlatQuad(Mesh& mesh, const std::array<Vector3d, 4>& corners_ccw,
                               double uv_per_m, double shade) {
  const Vector3d right = corners_ccw[1] - corners_ccw[0];
  const Vector3d up = corners_ccw[3] - corners_ccw[0];
  const Vector3d normal = right.cross(up).normalized();
  // Texture coordinates start elsewhere on every face, so that faces differ.
  const double u = uv_per_m * (corners_ccw[0].x() + 1.7 * corners_ccw[0].z());
  const double v = uv_per_m * corners_ccw[0].y();
  const double du = uv_per_m * right.norm();
  const double dv = uv_per_m * up.norm();
  const auto a = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(MakeVertex(corners_ccw[0], normal, u, v, shade));
  mesh.vertices.push_back(MakeVertex(corners_ccw[1], normal, u + du, v, shade));
  mesh.vertices.push_back(MakeVertex(corners_ccw[2], normal, u + du, v + dv, shade));
  mesh.vertices.push_back(MakeVertex(corners_ccw[3], normal, u, v + dv, shade));
  AddQuadIndices(mesh, a, a + 1, a + 2, a + 3);
}

void SceneBuilder::AddBox(const Box& box, int texture, double uv_per_m, double shade) {
  Mesh& mesh = MeshAt(box.foot_m, texture);
  const Vector3d along(std::cos(box.yaw_rad), std::sin(box.yaw_rad), 0.0);
  const Vector3d across = Vector3d::UnitZ().cross(along);
  std::array<Vector3d, 4> low;  // counter-clockwise from above
  std::array<Vector3d, 4> high;
  constexpr std::array<std::array<double, 2>, 4> kSigns = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3d corner =
        0.5 * (kSigns[i][0] * box.length_m * along + kSigns[i][1] * box.width_m * across);
    low[i] = box.foot_m + corner;
    high[i] = box.foot_m + box.top_scale * corner + box.height_m * Vector3d::UnitZ();
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    AddFlatQuad(mesh, {low[i], low[j], high[j], high[i]}, uv_per_m, shade);
  }
  AddFlatQuad(mesh, high, uv_per_m, shade);
}

void SceneBuilder::AddPole(const Pole& pole, int texture, double uv_per_m, double shade) {
  Mesh& mesh = MeshAt(pole.foot_m, texture);
  const Vector3d axis = pole.top_m - pole.foot_m;
  const Vector3d x = axis.unitOrthogonal();
  const Vector3d y = axis.normalized().cross(x);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const double circumference = 2.0 * pi * pole.foot_radius_m;
  for (int i = 0; i <= pole.sides; ++i) {
    const double angle = 2.0 * pi * i / pole.sides;
    const Vector3d out = std::cos(angle) * x + std::sin(angle) * y;
    const double u = uv_per_m * circumference * i / pole.sides;
    mesh.vertices.push_back(
        MakeVertex(pole.foot_m + pole.foot_radius_m * out, out, u, uv_per_m * axis.norm(), shade));
    mesh.vertices.push_back(MakeVertex(pole.top_m + pole.top_radius_m * out, out, u, 0.0, shade));
  }
  for (int i = 0; i < pole.sides; ++i) {
    const std::uint32_t a = first + 2 * static_cast<std::uint32_t>(i);
    AddQuadIndices(mesh, a, a + 2, a + 3, a + 1);
  }
  if (pole.capped) CapPole(mesh, pole, first, uv_per_m, shade);
}

void SceneBuilder::AddBlob(const Vector3d& center_m, const Vector3d& radii_m, int texture,
                           double shade, RandomStream::Sample& random) {
  constexpr int kRings = 4;
  constexpr int kSectors = 6;
  constexpr double kTexture_m = 2.5;  // one repeat
  Mesh& mesh = MeshAt(center_m, texture);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const double u0 = random.Uniform();
  for (int ring = 0; ring <= kRings; ++ring) {
    const double polar = pi * ring / kRings;
    for (int sector = 0; sector <= kSectors; ++sector) {
      const double around = 2.0 * pi * (sector % kSectors) / kSectors;
      const Vector3d out(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around),
                         std::cos(polar));
      // The last sector repeats the first and the poles are one point each: no lumps there.
      const bool seam = sector % kSectors == 0 || ring == 0 || ring == kRings;
      const double lump = seam ? 1.0 : 0.75 + 0.5 * random.Uniform();
      // Leaves below are in the shade of those above.
      const double here = shade * (0.7 + 0.3 * out.z()) * (0.8 + 0.4 * random.Uniform());
      const double u = u0 + 2.0 * radii_m.x() * pi / kTexture_m * sector / kSectors;
      mesh.vertices.push_back(MakeVertex(center_m + lump * radii_m.cwiseProduct(out), out, u,
                                         pi * radii_m.z() / kTexture_m * ring / kRings, here));
    }
  }
  for (int ring = 0; ring < kRings; ++ring) {
    for (int sector = 0; sector < kSectors; ++sector) {
      const std::uint32_t a = first + static_cast<std::uint32_t>(ring * (kSectors + 1) + sector);
      const std::uint32_t b = a + kSectors + 1;
      // At the poles one of the two triangles has no area.
      if (ring < kRings - 1) mesh.indices.insert(mesh.indices.end(), {a, b, b + 1});
      if (ring > 0) mesh.indices.insert(mesh.indices.end(), {a, b + 1, a + 1});
    }
  }
}

void SceneBuilder::AddModel(const std::vector<Mesh>& meshes_A, const nav::Pose& T_WA) {
  for (const Mesh& model : meshes_A) {
    SetLabel(model.label);
    SetDetail(model.draw_distance_m < 1e5F);
    Mesh& mesh = MeshAt(T_WA.p, model.texture);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vertex& v : model.vertices) {
      mesh.vertices.push_back({(T_WA * v.p_W_m.cast<double>()).cast<float>(),
                               (T_WA.q * v.normal_W.cast<double>()).cast<float>(), v.uv, v.shade});
    }
    for (const std::uint32_t index : model.indices) mesh.indices.push_back(first + index);
  }
  SetDetail(false);
}

}  // namespace polnav::sim
