// What hides the sky from a sensor?
//
// Rays against the triangles of a scene: what stands still in a tree of Bullet's, what moves where
// it is at the instant. A hidden ray brings unpolarized light of the surface's own radiance: its
// kind's mean reflectance times the light on it, without its texture, so that it does not depend on
// whether anybody draws pictures. Foliage lets rays through at random spots that stay where they
// are (Mesh::cover). Every method may be called from any thread.
// Not in it: light that the ground and walls polarize by reflection, the colour of leaves' light.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "nav/api/geometry.h"
#include "nav/api/time.h"
#include "sim/world/scene.h"
#include "sim/world/skyline.h"

namespace polnav::sim {

class Occlusion {
 public:
  // Radiance of a white facet with this normal (W), relative to the clear zenith.
  using LightOfWhite = std::function<double(const Eigen::Vector3d& normal_W)>;

  // The scene must outlive it. Throws std::invalid_argument above two million triangles.
  Occlusion(const Scene& scene, LightOfWhite light_of_white);
  ~Occlusion();
  Occlusion(const Occlusion&) = delete;
  Occlusion& operator=(const Occlusion&) = delete;

  struct Hit {
    double distance_m = 0.0;
    Label label = Label::kSky;
    double radiance = 0.0;
  };

  // What an eye sees of the scene at an instant, within a cone: what to hold while looking along
  // many of its rays.
  class View {
   public:
    // True: no ray of the cone meets anything.
    [[nodiscard]] bool empty() const { return !may_meet_static_ && actors_.empty(); }
    // ray_W: unit vector within the cone.
    [[nodiscard]] std::optional<Hit> Look(const Eigen::Vector3d& ray_W) const;
    // Whether a camera at the eye sees something else in front of this point, up to 5 mm before it.
    // As pictures have it: surfaces hide what is behind their front only, and foliage has no gaps.
    [[nodiscard]] bool Hides(const Eigen::Vector3d& p_W_m) const;
    [[nodiscard]] const Eigen::Vector3d& eye_W_m() const { return eye_W_m_; }

   private:
    friend class Occlusion;
    struct PlacedActor {
      std::size_t index;
      nav::Pose T_AW;
      Eigen::Vector3d center_W_m;
    };
    const Occlusion* scene_ = nullptr;
    Eigen::Vector3d eye_W_m_ = Eigen::Vector3d::Zero();
    bool may_meet_static_ = false;
    std::optional<Skyline> skyline_;  // in a wide cone, of what stands still
    std::vector<PlacedActor> actors_;
  };
  // axis_W: unit vector; half_angle_rad up to pi.
  [[nodiscard]] View From(const Eigen::Vector3d& eye_W_m, const Eigen::Vector3d& axis_W,
                          double half_angle_rad, nav::TimeNs stamp) const;
  // All around, for a few rays.
  [[nodiscard]] View Around(const Eigen::Vector3d& eye_W_m, nav::TimeNs stamp) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polnav::sim
