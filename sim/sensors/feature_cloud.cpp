#include "sim/sensors/feature_cloud.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace polnav::sim {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using Triangle = std::array<Vector3d, 3>;

constexpr double kNearest_m = 3.0;  // no picture shows anything large from nearer
constexpr double kPatch_m = 8.0;    // side of a square of ground

struct Surface {
  Vector3d normal;
  double density_sr;  // points a steradian
  double reach_m;     // at most
};

class Sower {
 public:
  Sower(const std::vector<Vector3d>& viewpoints, RandomStream::Sample random)
      : viewpoints_(viewpoints), random_(random) {}

  void Sow(const Scene& scene, const Mesh& mesh, const FeatureOptions& options) {
    const auto texture = static_cast<std::size_t>(mesh.texture);
    const double detail = texture < scene.detail.size() ? scene.detail[texture] : 1.0;
    Surface surface{.density_sr = options.points_per_sr * detail,
                    .reach_m = std::min<double>(options.max_distance_m, mesh.draw_distance_m)};
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      Triangle corners;
      for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = mesh.vertices[mesh.indices[i + k]].p_W_m.cast<double>();
      }
      const Vector3d across = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
      if (across.norm() == 0.0) continue;
      surface.normal = across.normalized();
      Sow(corners, surface);
    }
  }

  [[nodiscard]] std::vector<FeaturePoint> Take() { return std::move(points_); }

 private:
  // Of an actor nobody knows how near it comes.
  [[nodiscard]] double NearestView(const Vector3d& p_m) const {
    if (viewpoints_.empty()) return 0.0;
    double nearest2 = std::numeric_limits<double>::infinity();
    for (const Vector3d& v : viewpoints_) nearest2 = std::min(nearest2, (v - p_m).squaredNorm());
    return std::sqrt(nearest2);
  }

  void Sow(const Triangle& t, const Surface& surface) {
    const Vector3d middle = (t[0] + t[1] + t[2]) / 3.0;
    double radius = 0.0;
    for (const Vector3d& corner : t) radius = std::max(radius, (corner - middle).norm());
    const double nearest = NearestView(middle);
    if (nearest - radius > surface.reach_m) return;
    // Density is taken as constant where it changes little.
    if (radius > std::max(kNearest_m, nearest) / 4.0) {
      const Vector3d a = 0.5 * (t[1] + t[2]);
      const Vector3d b = 0.5 * (t[2] + t[0]);
      const Vector3d c = 0.5 * (t[0] + t[1]);
      for (const Triangle& part :
           {Triangle{t[0], c, b}, Triangle{c, t[1], a}, Triangle{b, a, t[2]}, Triangle{a, b, c}}) {
        Sow(part, surface);
      }
      return;
    }
    const double r = std::max(kNearest_m, nearest);
    const double area = 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
    const double count = std::floor(area * surface.density_sr / (r * r) + random_.Uniform());
    for (int i = 0; i < static_cast<int>(count); ++i) Put(t, r, surface);
  }

  void Put(const Triangle& t, double r, const Surface& surface) {
    double u = random_.Uniform();
    double v = random_.Uniform();
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    const Vector3d p = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
    const double reach = std::min(surface.reach_m, r / std::sqrt(1.0 - random_.Uniform()));
    points_.push_back({p.cast<float>(), surface.normal.cast<float>(), static_cast<float>(reach),
                       static_cast<float>(random_.Uniform())});
  }

  const std::vector<Vector3d>& viewpoints_;
  RandomStream::Sample random_;
  std::vector<FeaturePoint> points_;
};

void AddPatch(int actor, std::vector<FeaturePoint> points, FeatureCloud& cloud) {
  std::stable_sort(points.begin(), points.end(), [](const FeaturePoint& a, const FeaturePoint& b) {
    return a.reach_m > b.reach_m;
  });
  FeaturePatch patch{.actor = actor};
  Eigen::AlignedBox3f box;
  Vector3f sum = Vector3f::Zero();
  for (const FeaturePoint& point : points) {
    box.extend(point.p_m);
    sum += point.normal;
  }
  patch.center_m = box.center();
  patch.axis = sum.normalized();
  for (const FeaturePoint& point : points) {
    const Vector3f from_center = point.p_m - patch.center_m;
    patch.radius_m = std::max(patch.radius_m, from_center.norm());
    patch.depth_m = std::max(patch.depth_m, -from_center.dot(patch.axis));
    patch.spread = std::max(patch.spread, point.normal.cross(patch.axis).norm());
  }
  patch.begin = static_cast<std::uint32_t>(cloud.points.size());
  cloud.points.insert(cloud.points.end(), points.begin(), points.end());
  patch.end = static_cast<std::uint32_t>(cloud.points.size());
  cloud.patches.push_back(patch);
}

// Which of six sides it faces.
int SideOf(const Vector3f& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return 2 * static_cast<int>(axis) + (normal(axis) < 0.0F ? 1 : 0);
}

void AddPatches(int actor, const std::vector<FeaturePoint>& points, FeatureCloud& cloud) {
  std::map<std::array<int, 3>, std::vector<FeaturePoint>> parts;
  for (const FeaturePoint& point : points) {
    parts[{static_cast<int>(std::floor(point.p_m.x() / kPatch_m)),
           static_cast<int>(std::floor(point.p_m.y() / kPatch_m)), SideOf(point.normal)}]
        .push_back(point);
  }
  for (auto& [key, part] : parts) AddPatch(actor, std::move(part), cloud);
}

}  // namespace

FeatureCloud DrawFeatureCloud(const Scene& scene, const FeatureOptions& options,
                              const std::vector<Vector3d>& viewpoints_W_m, std::uint64_t seed,
                              std::uint64_t trial) {
  FeatureCloud cloud;
  Sower still(viewpoints_W_m, RandomStream(seed, trial, "stereo/features/cloud").At(0));
  for (const Mesh& mesh : scene.meshes) still.Sow(scene, mesh, options);
  AddPatches(-1, still.Take(), cloud);
  const RandomStream stream(seed, trial, "stereo/features/actors");
  const std::vector<Vector3d> anywhere;
  for (std::size_t i = 0; i < scene.actors.size(); ++i) {
    Sower sower(anywhere, stream.At(i));
    for (const Mesh& mesh : scene.actors[i].meshes) sower.Sow(scene, mesh, options);
    AddPatches(static_cast<int>(i), sower.Take(), cloud);
  }
  return cloud;
}

}  // namespace polnav::sim
