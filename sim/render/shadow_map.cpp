#include "sim/render/shadow_map.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace polnav::sim {
namespace {

// Casters are drawn deeper than they are, so that they do not shadow themselves between texels: by
// so many times what depth changes by from texel to texel, two of which the filter spans.
constexpr float kSlopeOffset = 2.0F;
constexpr float kConstantOffset = 4.0F;  // of the depth's resolution

}  // namespace

Eigen::Matrix3d AxesAlongSun(const Eigen::Vector3d& sun_W) {
  const Eigen::Vector3d z = sun_W.normalized();
  const Eigen::Vector3d sideways = Eigen::Vector3d::UnitZ().cross(z);
  const Eigen::Vector3d x =
      sideways.norm() > 1e-6 ? Eigen::Vector3d(sideways.normalized()) : Eigen::Vector3d::UnitX();
  Eigen::Matrix3d axes;
  axes << x.transpose(), z.cross(x).transpose(), z.transpose();
  return axes;
}

ShadowMap::ShadowMap(const GlFunctions& gl, const Eigen::Vector3d& sun_W, int width_px,
                     int height_px)
    : gl_(gl), axes_(AxesAlongSun(sun_W)), width_px_(width_px), height_px_(height_px) {
  gl_.GenTextures(1, &texture_);
  gl_.BindTexture(GL_TEXTURE_2D, texture_);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, width_px, height_px, 0, GL_DEPTH_COMPONENT,
                 GL_UNSIGNED_INT, nullptr);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
    gl_.TexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);  // of four comparisons
  }
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) {
    gl_.TexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
  }
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  gl_.GenFramebuffers(1, &framebuffer_);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture_, 0);
  gl_.DrawBuffer(GL_NONE);
  gl_.ReadBuffer(GL_NONE);
  if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error("OSMesa gives no depth buffer of " + std::to_string(width_px) + " x " +
                             std::to_string(height_px) + " pixels");
  }
}

Eigen::Matrix4f ShadowMap::BeginDrawing(const Eigen::AlignedBox3d& box) {
  // Two texels of border that nothing covers: what lies outside meets the clear depth there.
  const Eigen::Array3d pixels(width_px_ - 4.0, height_px_ - 4.0, 1.0);
  const Eigen::Array3d margin = Eigen::Array3d(2.0, 2.0, 0.01) * box.sizes().array() / pixels;
  const Eigen::Array3d low = box.min().array() - margin;
  const Eigen::Array3d size = box.sizes().array() + 2.0 * margin;
  Eigen::Matrix4d clip_from_W = Eigen::Matrix4d::Identity();
  const Eigen::Array3d scale = Eigen::Array3d(2.0, 2.0, -2.0) / size;
  clip_from_W.topLeftCorner<3, 3>() = scale.matrix().asDiagonal() * axes_;
  clip_from_W.topRightCorner<3, 1>() = (-scale * (low + 0.5 * size)).matrix();
  Eigen::Matrix4d map_from_clip = Eigen::Matrix4d::Identity();
  map_from_clip.topLeftCorner<3, 3>() *= 0.5;
  map_from_clip.topRightCorner<3, 1>().setConstant(0.5);
  map_from_W_ = (map_from_clip * clip_from_W).cast<float>();

  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.Viewport(0, 0, width_px_, height_px_);
  gl_.Clear(GL_DEPTH_BUFFER_BIT);
  gl_.Enable(GL_POLYGON_OFFSET_FILL);
  gl_.PolygonOffset(kSlopeOffset, kConstantOffset);
  gl_.Disable(GL_CULL_FACE);
  return clip_from_W.cast<float>();
}

void ShadowMap::EndDrawing() const { gl_.Disable(GL_POLYGON_OFFSET_FILL); }

void ShadowMap::Bind(GLenum unit) const {
  gl_.ActiveTexture(unit);
  gl_.BindTexture(GL_TEXTURE_2D, texture_);
  gl_.ActiveTexture(GL_TEXTURE0);
}

std::vector<float> ShadowMap::ReadDepths() const {
  std::vector<float> depths(static_cast<std::size_t>(width_px_) *
                            static_cast<std::size_t>(height_px_));
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.PixelStorei(GL_PACK_ROW_LENGTH, 0);
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 4);
  gl_.ReadPixels(0, 0, width_px_, height_px_, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
  return depths;
}

SunLitTriangles::SunLitTriangles(const ShadowMap& map)
    : map_from_W_(map.map_from_W()),
      width_px_(map.width_px()),
      height_px_(map.height_px()),
      depths_(map.ReadDepths()) {}

// In the four texels that the filter looks at.
int SunLitTriangles::LitTexels(const Eigen::Vector3f& map_point) const {
  const float x = map_point.x() * static_cast<float>(width_px_) - 0.5F;
  const float y = map_point.y() * static_cast<float>(height_px_) - 0.5F;
  int lit = 0;
  for (const int dx : {0, 1}) {
    for (const int dy : {0, 1}) {
      const int col = std::clamp(static_cast<int>(std::floor(x)) + dx, 0, width_px_ - 1);
      const int row = std::clamp(static_cast<int>(std::floor(y)) + dy, 0, height_px_ - 1);
      const float depth =
          depths_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_px_) +
                  static_cast<std::size_t>(col)];
      lit += std::min(map_point.z(), 1.0F) <= depth ? 1 : 0;
    }
  }
  return lit;
}

bool SunLitTriangles::IsLit(const Eigen::Vector3f& p_W) const {
  return LitTexels((map_from_W_ * p_W.homogeneous()).head<3>()) >= 2;
}

// At points a texel or two apart; a triangle that would take too many is left to the renderer.
SunLitness SunLitTriangles::Of(const std::array<Eigen::Vector3f, 3>& corners_W) const {
  constexpr float kSpacing_px = 1.5F;
  constexpr int kMostSteps = 250;
  std::array<Eigen::Vector3f, 3> p;
  for (std::size_t i = 0; i < 3; ++i) p[i] = (map_from_W_ * corners_W[i].homogeneous()).head<3>();
  const Eigen::Array2f px(static_cast<float>(width_px_), static_cast<float>(height_px_));
  float longest_px = 0.0F;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Array2f side = (p[(i + 1) % 3] - p[i]).head<2>().array() * px;
    longest_px = std::max(longest_px, side.matrix().norm());
  }
  const int steps = 1 + static_cast<int>(longest_px / kSpacing_px);
  if (steps > kMostSteps) return SunLitness::kMixed;
  const int all = LitTexels(p[0]);
  for (int i = 0; i <= steps; ++i) {
    for (int k = 0; k <= steps - i; ++k) {
      const float a = static_cast<float>(i) / static_cast<float>(steps);
      const float b = static_cast<float>(k) / static_cast<float>(steps);
      const int here = LitTexels(p[0] + a * (p[1] - p[0]) + b * (p[2] - p[0]));
      if (here != all || here % 4 != 0) return SunLitness::kMixed;
    }
  }
  return all == 4 ? SunLitness::kLit : SunLitness::kDark;
}

}  // namespace polnav::sim
