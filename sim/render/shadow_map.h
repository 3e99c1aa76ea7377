// Where does sunlight get to?
//
// A depth picture of what casts shadows, seen along the sunlight (parallel). A point is lit when
// nothing nearer to the sun covers it. Depth runs from 0 towards the sun to 1; whatever lies
// outside the map is lit.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "sim/render/gl_context.h"

namespace polnav::sim {

// Axes of the picture in W: right, up, and towards the sun.
[[nodiscard]] Eigen::Matrix3d AxesAlongSun(const Eigen::Vector3d& sun_W);

class ShadowMap {
 public:
  ShadowMap(const GlFunctions& gl, const Eigen::Vector3d& sun_W, int width_px, int height_px);

  // Clears the map, aims it at the box and draws into it until EndDrawing. Returns clip_from_W.
  Eigen::Matrix4f BeginDrawing(const Eigen::AlignedBox3d& box);
  void EndDrawing() const;

  // W to texture coordinates and depth, all from 0 to 1.
  [[nodiscard]] const Eigen::Matrix4f& map_from_W() const { return map_from_W_; }
  void Bind(GLenum unit) const;  // as a sampler2DShadow

  // Of the map's texels; row by row from below.
  [[nodiscard]] std::vector<float> ReadDepths() const;
  [[nodiscard]] int width_px() const { return width_px_; }
  [[nodiscard]] int height_px() const { return height_px_; }
  [[nodiscard]] const Eigen::Matrix3d& axes() const { return axes_; }

 private:
  const GlFunctions& gl_;
  Eigen::Matrix3d axes_;  // rows: right, up, towards the sun
  int width_px_;
  int height_px_;
  GLuint texture_ = 0;
  GLuint framebuffer_ = 0;
  Eigen::Matrix4f map_from_W_ = Eigen::Matrix4f::Identity();
};

// Is a triangle that faces the sun wholly in its light, wholly in shadow, or crossed by an edge?
enum class SunLitness { kLit, kDark, kMixed };

class SunLitTriangles {
 public:
  explicit SunLitTriangles(const ShadowMap& map);
  [[nodiscard]] SunLitness Of(const std::array<Eigen::Vector3f, 3>& corners_W) const;
  [[nodiscard]] bool IsLit(const Eigen::Vector3f& p_W) const;  // the most of it

 private:
  [[nodiscard]] int LitTexels(const Eigen::Vector3f& map_point) const;  // of four

  Eigen::Matrix4f map_from_W_;
  int width_px_;
  int height_px_;
  std::vector<float> depths_;
};

}  // namespace polnav::sim
