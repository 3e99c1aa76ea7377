// Which shadows does sunlight cast, of what stands still and of what moves?
//
// One map of everything that stands, drawn once: the sun stands still during a run. One of the
// actors about the eye, drawn anew for every instant. The ground casts none.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "sim/render/gl_context.h"
#include "sim/render/gpu_actors.h"
#include "sim/render/shadow_map.h"
#include "sim/world/scene.h"

namespace polnav::sim {

class Shadows {
 public:
  Shadows(const GlContext& context, const Scene& scene, const Eigen::Vector3d& sun_W);

  [[nodiscard]] const ShadowMap& standing() const { return standing_; }
  [[nodiscard]] const ShadowMap& moving() const { return moving_; }

  // Picks those of them whose shadows may be seen from near the eye; the same for both of a pair.
  void Pick(const std::vector<GpuActors::Placed>& placed, nav::TimeNs stamp,
            const Eigen::Vector3d& eye_W);
  // May the shadow of any of those fall on something in the box, in the axes along the sun?
  [[nodiscard]] bool MayFallOn(const Eigen::AlignedBox3d& box) const;
  // Draws the moving map of those, unless it shows just them. Depends on nothing else drawn before.
  void DrawPicked(const GpuActors& actors);

 private:
  void DrawStanding(const Scene& scene);

  const GlContext& context_;
  GLuint depth_program_;
  GLint clip_from_W_;
  GLint W_from_A_;
  ShadowMap standing_;
  ShadowMap moving_;
  std::optional<std::pair<nav::TimeNs, Eigen::Vector3d>> picked_at_;
  bool drawn_ = false;  // the moving map, of those picked
  std::vector<GpuActors::Placed> picked_;
  std::vector<BoundingSphere> casters_;  // the same, in the axes along the sun
};

}  // namespace polnav::sim
