#include "sim/sensors/truth_raster.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "sim/sensors/lens.h"
#include "sim/sensors/lens_warp.h"
#include "sim/world/actor.h"

namespace polnav::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMargin_px = 2.0;

}  // namespace

TruthRaster::TruthRaster(const Scene& scene, const nav::CameraCalibration& camera)
    : camera_(camera), frustum_(CoveringView({camera}, 1.0)) {
  for (int row = 0; row < camera.height_px; ++row) {
    for (int col = 0; col < camera.width_px; ++col) {
      rays_C_.push_back(RayOfPixel(camera, col, row).homogeneous());
      field_.extend(rays_C_.back().head<2>());
    }
  }
  for (const Mesh& mesh : scene.meshes) {
    if (!mesh.vertices.empty()) standing_.push_back(ShapeOf(mesh, static_cast<int>(mesh.label)));
  }
  for (const Actor& actor : scene.actors) {
    const int instance = kFirstActor + static_cast<int>(acting_.size());
    std::vector<Shape>& shapes = acting_.emplace_back();
    for (const Mesh& mesh : actor.meshes) {
      if (!mesh.vertices.empty()) shapes.push_back(ShapeOf(mesh, instance));
    }
    paths_.push_back(actor.path);
  }
}

// The sphere as the renderer has it: what it leaves out beyond draw_distance_m is left out here.
TruthRaster::Shape TruthRaster::ShapeOf(const Mesh& mesh, int instance) {
  Shape shape{
      .indices = mesh.indices, .draw_distance_m = mesh.draw_distance_m, .instance = instance};
  Eigen::AlignedBox3d box;
  for (const Vertex& v : mesh.vertices) {
    shape.points.push_back(v.p_W_m.cast<double>());
    box.extend(shape.points.back());
  }
  shape.center = box.center();
  for (const Vector3d& p : shape.points) {
    shape.radius_m = std::max(shape.radius_m, (p - shape.center).norm());
  }
  return shape;
}

TruthLayers TruthRaster::Draw(const nav::Pose& T_WC, nav::TimeNs stamp) const {
  TruthLayers layers{cv::Mat(camera_.height_px, camera_.width_px, CV_32FC1,
                             cv::Scalar(std::numeric_limits<float>::infinity())),
                     cv::Mat(camera_.height_px, camera_.width_px, CV_16UC1,
                             cv::Scalar(static_cast<int>(Label::kSky)))};
  const nav::Pose T_CW = T_WC.Inverse();
  for (const Shape& shape : standing_) DrawShape(shape, T_CW, layers);
  for (std::size_t i = 0; i < acting_.size(); ++i) {
    const auto T_WA = PoseOf(paths_[i], stamp);
    if (!T_WA) continue;
    for (const Shape& shape : acting_[i]) DrawShape(shape, T_CW * *T_WA, layers);
  }
  return layers;
}

void TruthRaster::DrawShape(const Shape& shape, const nav::Pose& T_CA, TruthLayers& layers) const {
  const Vector3d center_C = T_CA * shape.center;
  if (!frustum_.MayShow(center_C, shape.radius_m)) return;
  if (center_C.norm() - shape.radius_m > shape.draw_distance_m) return;
  const Eigen::Matrix3d R_CA = T_CA.q.toRotationMatrix();
  std::vector<Vector3d> points_C;
  points_C.reserve(shape.points.size());
  for (const Vector3d& p : shape.points) points_C.emplace_back(R_CA * p + T_CA.p);
  for (std::size_t i = 0; i + 2 < shape.indices.size(); i += 3) {
    DrawTriangle({points_C[shape.indices[i]], points_C[shape.indices[i + 1]],
                  points_C[shape.indices[i + 2]]},
                 shape.instance, layers);
  }
}

// Pixels that a triangle may cover; all of the picture when it reaches beside or behind the camera.
cv::Rect TruthRaster::Reach(const std::array<Vector3d, 3>& p_C) const {
  const cv::Rect all(0, 0, camera_.width_px, camera_.height_px);
  Eigen::AlignedBox2d ideal;
  for (const Vector3d& p : p_C) {
    if (p.z() < 0.5 * kNear_m) return all;
    ideal.extend(p.head<2>() / p.z());
  }
  ideal = ideal.intersection(field_);
  if (ideal.isEmpty()) return {};
  // The lens bends the box; points along a border at most a tenth apart leave less than the margin.
  const Vector2d size = ideal.sizes();
  const int steps = 1 + static_cast<int>(10.0 * size.maxCoeff());
  Eigen::AlignedBox2d raw;
  for (int i = 0; i <= steps; ++i) {
    const Vector2d along = size * i / steps;
    for (const Vector2d& xy : {Vector2d(ideal.min().x() + along.x(), ideal.min().y()),
                               Vector2d(ideal.min().x() + along.x(), ideal.max().y()),
                               Vector2d(ideal.min().x(), ideal.min().y() + along.y()),
                               Vector2d(ideal.max().x(), ideal.min().y() + along.y())}) {
      raw.extend(ProjectToPixel(camera_, xy.homogeneous()));
    }
  }
  const cv::Point low(static_cast<int>(std::floor(raw.min().x() - kMargin_px)),
                      static_cast<int>(std::floor(raw.min().y() - kMargin_px)));
  const cv::Point high(static_cast<int>(std::ceil(raw.max().x() + kMargin_px)) + 1,
                       static_cast<int>(std::ceil(raw.max().y() + kMargin_px)) + 1);
  return cv::Rect(low, high) & all;
}

// A ray is inside when it passes all three edges on the same side; no clipping needed. On the plane
// n . p = n . a, and so z = n . a / n . ray.
void TruthRaster::DrawTriangle(const std::array<Vector3d, 3>& p_C, int instance,
                               TruthLayers& layers) const {
  const auto& [a, b, c] = p_C;
  if (std::max({a.z(), b.z(), c.z()}) < kNear_m) return;
  const Vector3d normal = (b - a).cross(c - a);
  const double distance = normal.dot(a);
  if (distance >= 0.0) return;  // seen from behind
  const cv::Rect reach = Reach(p_C);
  const Vector3d ab = b.cross(a);
  const Vector3d bc = c.cross(b);
  const Vector3d ca = a.cross(c);
  for (int v = reach.y; v < reach.y + reach.height; ++v) {
    auto* const depth = layers.depth_m.ptr<float>(v);
    auto* const label = layers.instance.ptr<std::uint16_t>(v);
    const Vector3d* const rays = &rays_C_[static_cast<std::size_t>(v * camera_.width_px)];
    for (int u = reach.x; u < reach.x + reach.width; ++u) {
      if (ab.dot(rays[u]) < 0.0 || bc.dot(rays[u]) < 0.0 || ca.dot(rays[u]) < 0.0) continue;
      const double z = distance / normal.dot(rays[u]);
      if (!(z > kNear_m && z < kFar_m) || z >= depth[u]) continue;
      depth[u] = static_cast<float>(z);
      label[u] = static_cast<std::uint16_t>(instance);
    }
  }
}

}  // namespace polnav::sim
