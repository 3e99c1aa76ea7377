// What does a ray meet, exactly? Independent of the renderer: every triangle is asked, in doubles.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <vector>

#include "nav/api/geometry.h"
#include "sim/sensors/frame_truth.h"
#include "sim/world/actor.h"
#include "sim/world/scene.h"

namespace polnav::sim {

class RayCaster {
 public:
  RayCaster(const Scene& scene, nav::TimeNs stamp) {
    for (const Mesh& mesh : scene.meshes) Add(mesh, {}, static_cast<int>(mesh.label));
    for (std::size_t i = 0; i < scene.actors.size(); ++i) {
      const auto T_WA = PoseOf(scene.actors[i].path, stamp);
      if (!T_WA) continue;
      for (const Mesh& mesh : scene.actors[i].meshes) {
        Add(mesh, *T_WA, kFirstActor + static_cast<int>(i));
      }
    }
  }

  struct Hit {
    double share = 0.0;  // of `direction`
    int instance = 0;
  };

  // The first front face on p + share * direction, share > 0.
  [[nodiscard]] std::optional<Hit> Cast(const Eigen::Vector3d& p,
                                        const Eigen::Vector3d& direction) const {
    Hit best{.share = std::numeric_limits<double>::infinity()};
    for (const Group& group : groups_) {
      const Eigen::Vector3d to = group.center - p;
      const double along = to.dot(direction) / direction.squaredNorm();
      if ((to - along * direction).norm() > group.radius) continue;
      for (const Triangle& t : group.triangles) {
        const double share = Meet(t, p, direction);
        if (share > 1e-9 && share < best.share) best = {share, group.instance};
      }
    }
    if (best.share == std::numeric_limits<double>::infinity()) return std::nullopt;
    return best;
  }

  // True: nothing between p and the point, up to a thousandth of the way.
  [[nodiscard]] bool Sees(const Eigen::Vector3d& p, const Eigen::Vector3d& point) const {
    const auto hit = Cast(p, point - p);
    return !hit || hit->share > 0.999;
  }

 private:
  struct Triangle {
    Eigen::Vector3d a, ab, ac;
  };
  struct Group {
    int instance = 0;
    Eigen::Vector3d center;
    double radius = 0.0;
    std::vector<Triangle> triangles;
  };

  void Add(const Mesh& mesh, const nav::Pose& T_WA, int instance) {
    constexpr std::size_t kTriangles = 64;  // a group: neighbours in the mesh
    for (std::size_t first = 0; first < mesh.indices.size(); first += 3 * kTriangles) {
      Group group{.instance = instance};
      Eigen::AlignedBox3d box;
      const std::size_t end = std::min(mesh.indices.size(), first + 3 * kTriangles);
      for (std::size_t i = first; i < end; i += 3) {
        Eigen::Vector3d v[3];
        for (std::size_t k = 0; k < 3; ++k) {
          v[k] = T_WA * mesh.vertices[mesh.indices[i + k]].p_W_m.cast<double>();
          box.extend(v[k]);
        }
        group.triangles.push_back({v[0], v[1] - v[0], v[2] - v[0]});
      }
      group.center = box.center();
      group.radius = 0.5 * box.diagonal().norm();
      groups_.push_back(std::move(group));
    }
  }

  // Moeller and Trumbore; negative where it misses or comes from behind.
  static double Meet(const Triangle& t, const Eigen::Vector3d& p, const Eigen::Vector3d& d) {
    const Eigen::Vector3d n = d.cross(t.ac);
    const double det = t.ab.dot(n);
    if (det <= 0.0) return -1.0;  // a back face
    const Eigen::Vector3d s = p - t.a;
    const double u = s.dot(n) / det;
    if (u < 0.0 || u > 1.0) return -1.0;
    const Eigen::Vector3d q = s.cross(t.ab);
    const double v = d.dot(q) / det;
    if (v < 0.0 || u + v > 1.0) return -1.0;
    return t.ac.dot(q) / det;
  }

  std::vector<Group> groups_;
};

}  // namespace polnav::sim
