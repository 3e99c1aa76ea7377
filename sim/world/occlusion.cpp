#include "sim/world/occlusion.h"

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/world/actor.h"
#include "sim/world/triangle_soup.h"

namespace polnav::sim {
namespace {

using Eigen::Vector3d;

// Whether a ball may be within a cone with its tip at the eye.
bool MayMeet(const Vector3d& from_eye, double radius, const Vector3d& axis, double half_angle) {
  const double distance = from_eye.norm();
  if (distance <= radius) return true;
  const double off_axis = std::atan2(from_eye.cross(axis).norm(), from_eye.dot(axis));
  return off_axis <= half_angle + std::asin(radius / distance);
}

class AnyInCone : public btTriangleCallback {
 public:
  AnyInCone(const Vector3d& eye, const Vector3d& axis, double half_angle)
      : eye_(eye), axis_(axis), half_angle_(half_angle) {}

  void processTriangle(btVector3* corners, int, int) override {
    if (found_) return;
    const btVector3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    double radius = 0.0;
    for (int k = 0; k < 3; ++k) radius = std::max(radius, (corners[k] - middle).length());
    found_ =
        MayMeet(Vector3d(middle.x(), middle.y(), middle.z()) - eye_, radius, axis_, half_angle_);
  }
  [[nodiscard]] bool found() const { return found_; }

 private:
  Vector3d eye_;
  Vector3d axis_;
  double half_angle_;
  bool found_ = false;
};

// Whether anything is in the way that a camera sees from its front.
class AnyInBetween : public btTriangleRaycastCallback {
 public:
  AnyInBetween(const btVector3& from, const btVector3& to)
      : btTriangleRaycastCallback(from, to, kF_FilterBackfaces) {}

  btScalar reportHit(const btVector3&, btScalar, int, int) override {
    found_ = true;
    return 0.0;  // nothing is nearer than that
  }
  [[nodiscard]] bool found() const { return found_; }

 private:
  bool found_ = false;
};

struct OwnShape {
  TriangleSoup soup;  // in A
  Vector3d center_m = Vector3d::Zero();
  double radius_m = 0.0;

  // Whether it is in the way between two points of A.
  [[nodiscard]] bool IsBetween(const Vector3d& from, const Vector3d& to) const {
    AnyInBetween search(ToBullet(from), ToBullet(to));
    for (std::size_t i = 0; i < soup.surfaces.size() && !search.found(); ++i) {
      btVector3 corners[3] = {soup.Corner(i, 0), soup.Corner(i, 1), soup.Corner(i, 2)};
      search.processTriangle(corners, 0, static_cast<int>(i));
    }
    return search.found();
  }
};

}  // namespace

struct Occlusion::Impl {
  const Scene& scene;
  LightOfWhite light_of_white;
  TriangleSoup still;
  std::unique_ptr<btTriangleIndexVertexArray> triangles;
  std::unique_ptr<btBvhTriangleMeshShape> tree;
  std::vector<Skyline::Cylinder> cylinders;  // one a triangle of what stands still
  std::vector<OwnShape> actors;

  Impl(const Scene& scene_in, LightOfWhite light)
      : scene(scene_in), light_of_white(std::move(light)) {
    for (const Mesh& mesh : scene.meshes) still.Add(scene, mesh);
    constexpr std::size_t kMost = (1U << 21U) - 1U;  // the tree's leaves have so many bits
    if (still.surfaces.size() > kMost) {
      throw std::invalid_argument("a scene of more than two million triangles");
    }
    if (!still.surfaces.empty()) {
      triangles = std::make_unique<btTriangleIndexVertexArray>(
          static_cast<int>(still.surfaces.size()), still.corners.data(),
          static_cast<int>(3 * sizeof(int)), static_cast<int>(still.points.size() / 3),
          still.points.data(), static_cast<int>(3 * sizeof(double)));
      tree = std::make_unique<btBvhTriangleMeshShape>(triangles.get(), true);
    }
    cylinders.reserve(still.surfaces.size());
    for (std::size_t i = 0; i < still.surfaces.size(); ++i) cylinders.push_back(CylinderOf(i));
    for (const Actor& actor : scene.actors) {
      OwnShape& shape = actors.emplace_back();
      for (const Mesh& mesh : actor.meshes) shape.soup.Add(scene, mesh);
      shape.center_m = shape.soup.box.center();
      shape.radius_m = 0.5 * shape.soup.box.diagonal().norm();
    }
  }

  [[nodiscard]] Skyline::Cylinder CylinderOf(std::size_t triangle) const {
    const btVector3 corners[3] = {still.Corner(triangle, 0), still.Corner(triangle, 1),
                                  still.Corner(triangle, 2)};
    const btVector3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    Skyline::Cylinder around{middle.x(), middle.y(), 0.0, corners[0].z()};
    for (const btVector3& corner : corners) {
      around.radius_m =
          std::max(around.radius_m, std::hypot(corner.x() - around.x_m, corner.y() - around.y_m));
      around.top_m = std::max(around.top_m, corner.z());
    }
    return around;
  }

  // Far enough to leave the scene.
  [[nodiscard]] double Reach(const Vector3d& eye, const Vector3d& ray) const {
    const double across = still.box.diagonal().norm() + (still.box.center() - eye).norm();
    if (ray.z() <= 1e-3) return across;
    return std::min(across, std::max(0.0, still.box.max().z() - eye.z()) / ray.z() + 0.1);
  }

  [[nodiscard]] std::optional<Hit> NearestStill(const Vector3d& eye, const Vector3d& ray) const {
    const Vector3d to = eye + Reach(eye, ray) * ray;
    NearestHit hit(still, eye, to);
    tree->performRaycast(&hit, ToBullet(eye), ToBullet(to));
    if (hit.hit() == nullptr) return std::nullopt;
    return HitOf(hit, Eigen::Quaterniond::Identity());
  }

  [[nodiscard]] bool MayMeetStill(const Vector3d& eye, const Vector3d& axis,
                                  double half_angle) const {
    if (!tree) return false;
    const double lowest = std::asin(std::clamp(axis.z(), -1.0, 1.0)) - half_angle;
    if (lowest < 0.1) return true;  // a wide cone meets something anyway
    const double height = still.box.max().z() - eye.z();
    if (height <= 0.0) return false;
    const double aside = height / std::tan(lowest);
    AnyInCone search(eye, axis, half_angle);
    tree->processAllTriangles(&search, ToBullet(eye - Vector3d(aside, aside, 0.0)),
                              ToBullet(eye + Vector3d(aside, aside, height)));
    return search.found();
  }

  // In the frame that the callback's ray is in; R turns it to W.
  [[nodiscard]] Hit HitOf(const NearestHit& nearest, const Eigen::Quaterniond& R) const {
    return {nearest.distance(), nearest.hit()->label,
            nearest.hit()->albedo * light_of_white(R * nearest.normal())};
  }
};

Occlusion::Occlusion(const Scene& scene, LightOfWhite light_of_white)
    : impl_(std::make_unique<Impl>(scene, std::move(light_of_white))) {}

Occlusion::~Occlusion() = default;

Occlusion::View Occlusion::From(const Vector3d& eye_W_m, const Vector3d& axis_W,
                                double half_angle_rad, nav::TimeNs stamp) const {
  View view;
  view.scene_ = this;
  view.eye_W_m_ = eye_W_m;
  view.may_meet_static_ = impl_->MayMeetStill(eye_W_m, axis_W, half_angle_rad);
  constexpr double kWide_rad = 0.5;  // many rays are to come: worth a look at every triangle
  if (view.may_meet_static_ && half_angle_rad > kWide_rad) {
    view.skyline_.emplace(eye_W_m);
    for (const Skyline::Cylinder& thing : impl_->cylinders) view.skyline_->Raise(thing);
  }
  for (std::size_t i = 0; i < impl_->actors.size(); ++i) {
    const std::optional<nav::Pose> T_WA = PoseOf(impl_->scene.actors[i].path, stamp);
    if (!T_WA) continue;
    const OwnShape& shape = impl_->actors[i];
    const Vector3d center_W = *T_WA * shape.center_m;
    if (MayMeet(center_W - eye_W_m, shape.radius_m, axis_W, half_angle_rad)) {
      view.actors_.push_back({i, T_WA->Inverse(), center_W});
    }
  }
  return view;
}

Occlusion::View Occlusion::Around(const Vector3d& eye_W_m, nav::TimeNs stamp) const {
  View view;
  view.scene_ = this;
  view.eye_W_m_ = eye_W_m;
  view.may_meet_static_ = impl_->tree != nullptr;
  for (std::size_t i = 0; i < impl_->actors.size(); ++i) {
    const std::optional<nav::Pose> T_WA = PoseOf(impl_->scene.actors[i].path, stamp);
    if (!T_WA) continue;
    view.actors_.push_back({i, T_WA->Inverse(), *T_WA * impl_->actors[i].center_m});
  }
  return view;
}

bool Occlusion::View::Hides(const Vector3d& p_W_m) const {
  constexpr double kAhead_m = 0.005;
  const Impl& impl = *scene_->impl_;
  const double distance = (p_W_m - eye_W_m_).norm();
  if (distance <= kAhead_m) return false;
  const Vector3d to = eye_W_m_ + (1.0 - kAhead_m / distance) * (p_W_m - eye_W_m_);
  if (may_meet_static_) {
    AnyInBetween search(ToBullet(eye_W_m_), ToBullet(to));
    impl.tree->performRaycast(&search, ToBullet(eye_W_m_), ToBullet(to));
    if (search.found()) return true;
  }
  const Vector3d ray = (to - eye_W_m_).normalized();
  return std::any_of(actors_.begin(), actors_.end(), [&](const PlacedActor& actor) {
    const OwnShape& shape = impl.actors[actor.index];
    const Vector3d to_center = actor.center_W_m - eye_W_m_;
    const double along = std::clamp(to_center.dot(ray), 0.0, distance);
    if ((along * ray - to_center).squaredNorm() > shape.radius_m * shape.radius_m) return false;
    return shape.IsBetween(actor.T_AW * eye_W_m_, actor.T_AW * to);
  });
}

std::optional<Occlusion::Hit> Occlusion::View::Look(const Vector3d& ray_W) const {
  const Impl& impl = *scene_->impl_;
  std::optional<Hit> nearest;
  const bool above_all = skyline_ && skyline_->IsBelow(ray_W);
  if (may_meet_static_ && !above_all) {
    nearest = impl.NearestStill(eye_W_m_, ray_W);
  }
  for (const PlacedActor& actor : actors_) {
    const OwnShape& shape = impl.actors[actor.index];
    const Vector3d eye_A = actor.T_AW * eye_W_m_;
    const Vector3d ray_A = actor.T_AW.q * ray_W;
    const Vector3d to_center = shape.center_m - eye_A;
    if (to_center.cross(ray_A).norm() > shape.radius_m) continue;
    const double far_m = to_center.norm() + shape.radius_m;
    NearestHit hit(shape.soup, eye_A, eye_A + far_m * ray_A);
    for (std::size_t i = 0; i < shape.soup.surfaces.size(); ++i) {
      btVector3 corners[3] = {shape.soup.Corner(i, 0), shape.soup.Corner(i, 1),
                              shape.soup.Corner(i, 2)};
      hit.processTriangle(corners, 0, static_cast<int>(i));
    }
    if (hit.hit() == nullptr || (nearest && nearest->distance_m < hit.distance())) continue;
    nearest = impl.HitOf(hit, actor.T_AW.q.conjugate());
  }
  return nearest;
}

}  // namespace polnav::sim
