// Whoever moves, at an instant: what of them is drawn, and what of them casts shadows?
#pragma once

#include <Eigen/Core>
#include <vector>

#include "nav/api/time.h"
#include "sim/render/gpu_scene.h"
#include "sim/render/surface_programs.h"
#include "sim/world/scene.h"

namespace polnav::sim {

class GpuActors {
 public:
  GpuActors(const GlFunctions& gl, const std::vector<Actor>& actors,
            const std::vector<GLuint>& textures);

  // An actor that is there, and where.
  struct Placed {
    std::size_t actor;
    Eigen::Matrix4f W_from_A;
    BoundingSphere sphere;  // in W
  };
  [[nodiscard]] std::vector<Placed> At(nav::TimeNs stamp) const;

  // With the textures, through a program that needs ACTOR.
  void Draw(const Placed& placed, const SurfacePrograms& programs) const;
  void DrawDepth(const Placed& placed, GLint W_from_A) const;

 private:
  struct Range {
    GLuint texture;
    std::size_t first;
    std::size_t count;
  };
  struct Loaded {
    std::vector<ActorKey> path;
    std::vector<Range> ranges;
    BoundingSphere sphere;  // in A
  };
  const GlFunctions& gl_;
  std::vector<Loaded> actors_;
  GLuint array_ = 0;
};

}  // namespace polnav::sim
