// What of the scene lies in the renderer's memory, and what of it can be in the picture?
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "nav/api/geometry.h"
#include "sim/render/frustum.h"
#include "sim/render/gl_context.h"
#include "sim/render/lighting.h"
#include "sim/world/scene.h"

namespace polnav::sim {

// Textured surfaces, lit when they are loaded: one vertex buffer, one draw call a mesh.
class GpuScene {
 public:
  GpuScene(const GlFunctions& gl, const Scene& scene, const Lighting& lighting);

  // Draws what the frustum may show, nearest first: hidden pixels then cost little.
  void Draw(const nav::Pose& T_CW, const Frustum& frustum);

 private:
  // Where one mesh lies in the buffers, and what it takes to leave it out.
  struct Range {
    Eigen::Vector3d center_W;
    double radius_m;
    float draw_distance_m;
    GLuint texture;
    GLsizei index_count;
    std::size_t first_index;
  };
  void LoadTextures(const std::vector<cv::Mat>& textures);

  const GlFunctions& gl_;
  std::vector<GLuint> textures_;
  std::vector<Range> ranges_;
  std::vector<std::pair<double, const Range*>> visible_;  // by distance
  GLuint vertices_ = 0;
};

// Untextured triangles: the sky's dome, or the mask over pixels nobody needs.
class GpuTriangles {
 public:
  // Three position components and a radiance a vertex.
  struct Vertex {
    Eigen::Vector3f position;
    float radiance;
  };
  GpuTriangles(const GlFunctions& gl, const std::vector<Vertex>& vertices,
               const std::vector<std::uint32_t>& indices);
  void Draw() const;

 private:
  const GlFunctions& gl_;
  GLuint vertices_ = 0;
  GLsizei index_count_ = 0;
};

}  // namespace polnav::sim
