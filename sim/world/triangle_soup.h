// Which triangle of many does a ray meet first? What occlusion.cpp works with.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "sim/world/scene.h"

namespace polnav::sim {

struct Surface {
  Label label;
  float cover;
  float albedo;  // reflectance of the surface, shade included
};

// Triangles as Bullet wants them, and what they belong to.
struct TriangleSoup {
  std::vector<double> points;
  std::vector<int> corners;
  std::vector<Surface> surfaces;  // one a triangle
  Eigen::AlignedBox3d box;

  void Add(const Scene& scene, const Mesh& mesh);

  [[nodiscard]] btVector3 Corner(std::size_t triangle, std::size_t k) const {
    const auto at = 3 * static_cast<std::size_t>(corners[3 * triangle + k]);
    return {points[at], points[at + 1], points[at + 2]};
  }
};

[[nodiscard]] inline btVector3 ToBullet(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

// The nearest surface along a ray that hides what is behind.
class NearestHit : public btTriangleRaycastCallback {
 public:
  NearestHit(const TriangleSoup& soup, const Eigen::Vector3d& from, const Eigen::Vector3d& to)
      : btTriangleRaycastCallback(ToBullet(from), ToBullet(to), kF_KeepUnflippedNormal),
        soup_(soup),
        from_(from),
        along_(to - from) {}

  btScalar reportHit(const btVector3& normal, btScalar fraction, int part, int triangle) override;

  [[nodiscard]] const Surface* hit() const { return hit_; }
  [[nodiscard]] const Eigen::Vector3d& normal() const { return normal_; }  // towards the eye
  [[nodiscard]] double distance() const { return m_hitFraction * along_.norm(); }

 private:
  const TriangleSoup& soup_;
  Eigen::Vector3d from_;
  Eigen::Vector3d along_;
  const Surface* hit_ = nullptr;
  Eigen::Vector3d normal_ = Eigen::Vector3d::UnitZ();
};

}  // namespace polnav::sim
