// What of the scene lies in the renderer's memory, and what of it can be in the picture?
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "nav/api/geometry.h"
#include "sim/render/frustum.h"
#include "sim/render/gl_context.h"
#include "sim/render/lighting.h"
#include "sim/render/shadow_map.h"
#include "sim/world/scene.h"

namespace polnav::sim {

struct BoundingSphere {
  Eigen::Vector3d center;
  double radius_m = 0.0;
};
// About the vertices' box.
[[nodiscard]] BoundingSphere SphereAround(const Mesh& mesh);

// One texture a scene's, mip-mapped.
[[nodiscard]] std::vector<GLuint> LoadTextures(const GlFunctions& gl,
                                               const std::vector<cv::Mat>& textures);

// What stands still: textured surfaces, lit when they are loaded. Triangles that an edge of a
// shadow crosses lie apart from those that are wholly lit or dark: only they need to ask the shadow
// map.
class GpuScene {
 public:
  GpuScene(const GlFunctions& gl, const Scene& scene, const std::vector<GLuint>& textures,
           const Lighting& lighting, const SunLitTriangles& sunlit);

  // Picks what the frustum may show.
  void Cull(const nav::Pose& T_CW, const Frustum& frustum);

  // Does may_fall(sun_box) hold for any of what was picked? A sun_box is about what gets sunlight,
  // in the axes along it; empty where nothing does.
  template <typename MayFall>
  [[nodiscard]] bool Any(const MayFall& may_fall) const {
    return std::any_of(visible_.begin(), visible_.end(),
                       [&](const Visible& v) { return may_fall(v.range->sun_box); });
  }

  enum class Part { kPlain, kShadowEdge };
  // Of what was picked, nearest shell first: hidden pixels then cost little. Only where
  // wanted(sun_box).
  template <typename Wanted>
  void Draw(Part part, const Wanted& wanted) {
    batch_.clear();
    for (const Visible& v : visible_) {
      const Indices& indices = part == Part::kPlain ? v.range->plain : v.range->shadow_edge;
      if (indices.count > 0 && wanted(v.range->sun_box)) batch_.push_back({v, indices});
    }
    DrawBatch();
  }

 private:
  struct Indices {
    std::size_t first = 0;
    std::size_t count = 0;
  };
  // Where one mesh lies in the buffers, and what it takes to leave it out.
  struct Range {
    BoundingSphere sphere;
    float draw_distance_m;
    GLuint texture;
    Eigen::AlignedBox3d sun_box;
    Indices plain;
    Indices shadow_edge;
  };
  struct Visible {
    int shell;
    const Range* range;
  };
  struct Wanted {
    Visible visible;
    Indices indices;
  };
  void DrawBatch();

  const GlFunctions& gl_;
  std::vector<Range> ranges_;
  std::vector<Visible> visible_;  // by shell, in a shell by texture
  // Reused.
  std::vector<Wanted> batch_;
  std::vector<GLsizei> counts_;
  std::vector<const void*> offsets_;
  GLuint array_ = 0;
};

// Untextured triangles: the sky's dome, the mask over pixels nobody needs, what casts shadows.
class GpuTriangles {
 public:
  // Three position components and a radiance a vertex.
  struct Vertex {
    Eigen::Vector3f position;
    float radiance;
  };
  GpuTriangles(const GlFunctions& gl, const std::vector<Vertex>& vertices,
               const std::vector<std::uint32_t>& indices);
  void Update(const std::vector<Vertex>& vertices) const;  // as many as before
  void Draw() const;
  void Draw(std::size_t first_index, std::size_t count) const;

 private:
  const GlFunctions& gl_;
  GLuint array_ = 0;
  GLuint vertices_ = 0;
  std::size_t index_count_ = 0;
};

}  // namespace polnav::sim
