#include "sim/render/shadows.h"

#include <algorithm>
#include <cmath>

#include "sim/render/shaders.h"

namespace polnav::sim {
namespace {

// A texel of the standing map: shadows of lamp posts are a few wide.
constexpr double kTexel_m = 0.05;
constexpr int kLargest_px = 4096;
// The moving map reaches so far from the eye.
constexpr double kReach_m = 45.0;
constexpr double kEyeCell_m = 4.0;  // within which the eye may be
constexpr int kMovingWidth_px = 1024;
constexpr int kMovingHeight_px = 512;

Eigen::AlignedBox3d BoxOfCasters(const Scene& scene, const Eigen::Matrix3d& axes) {
  Eigen::AlignedBox3d box;
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.label == Label::kGround) continue;
    for (const Vertex& v : mesh.vertices) box.extend(axes * v.p_W_m.cast<double>());
  }
  if (box.isEmpty()) box.extend(Eigen::Vector3d::Zero());
  return {box.min() - Eigen::Vector3d::Constant(0.1), box.max() + Eigen::Vector3d::Constant(0.1)};
}

int Pixels(double length_m) {
  return std::clamp(static_cast<int>(std::ceil(length_m / kTexel_m)), 16, kLargest_px);
}

ShadowMap StandingMap(const GlFunctions& gl, const Scene& scene, const Eigen::Vector3d& sun_W) {
  const Eigen::Vector3d size = BoxOfCasters(scene, AxesAlongSun(sun_W)).sizes();
  return {gl, sun_W, Pixels(size.x()), Pixels(size.y())};
}

}  // namespace

Shadows::Shadows(const GlContext& context, const Scene& scene, const Eigen::Vector3d& sun_W)
    : context_(context),
      depth_program_(context.LinkProgram(kDepthVertexShader, kDepthFragmentShader)),
      clip_from_W_(context.gl().GetUniformLocation(depth_program_, "clip_from_W")),
      W_from_A_(context.gl().GetUniformLocation(depth_program_, "W_from_A")),
      standing_(StandingMap(context.gl(), scene, sun_W)),
      moving_(context.gl(), sun_W, kMovingWidth_px, kMovingHeight_px) {
  DrawStanding(scene);
}

void Shadows::DrawStanding(const Scene& scene) {
  const GlFunctions& gl = context_.gl();
  std::vector<GpuTriangles::Vertex> vertices;
  std::vector<std::uint32_t> indices;
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.label == Label::kGround) continue;
    const auto base = static_cast<std::uint32_t>(vertices.size());
    for (const Vertex& v : mesh.vertices) vertices.push_back({v.p_W_m, 0.0F});
    for (const std::uint32_t index : mesh.indices) indices.push_back(base + index);
  }
  gl.Enable(GL_DEPTH_TEST);
  const Eigen::Matrix4f clip_from_W = standing_.BeginDrawing(BoxOfCasters(scene, standing_.axes()));
  gl.UseProgram(depth_program_);
  gl.UniformMatrix4fv(clip_from_W_, 1, GL_FALSE, clip_from_W.data());
  const Eigen::Matrix4f identity = Eigen::Matrix4f::Identity();
  gl.UniformMatrix4fv(W_from_A_, 1, GL_FALSE, identity.data());
  GpuTriangles(gl, vertices, indices).Draw();
  standing_.EndDrawing();
}

void Shadows::Pick(const std::vector<GpuActors::Placed>& placed, nav::TimeNs stamp,
                   const Eigen::Vector3d& eye_W) {
  const Eigen::Vector3d cell_W = kEyeCell_m * (eye_W / kEyeCell_m).array().floor();
  if (picked_at_ == std::pair(stamp, cell_W)) return;
  picked_at_ = {stamp, cell_W};
  drawn_ = false;
  const Eigen::Vector3d eye = moving_.axes() * cell_W;
  picked_.clear();
  casters_.clear();
  for (const GpuActors::Placed& one : placed) {
    const BoundingSphere sphere{moving_.axes() * one.sphere.center, one.sphere.radius_m};
    if ((sphere.center - eye).head<2>().norm() > kReach_m) continue;
    picked_.push_back(one);
    casters_.push_back(sphere);
  }
}

void Shadows::DrawPicked(const GpuActors& actors) {
  if (drawn_) return;
  drawn_ = true;
  const GlFunctions& gl = context_.gl();
  Eigen::AlignedBox3d box;
  for (const BoundingSphere& sphere : casters_) {
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(sphere.radius_m);
    box.extend(Eigen::AlignedBox3d(sphere.center - reach, sphere.center + reach));
  }
  const Eigen::Matrix4f clip_from_W = moving_.BeginDrawing(box);
  gl.UseProgram(depth_program_);
  gl.UniformMatrix4fv(clip_from_W_, 1, GL_FALSE, clip_from_W.data());
  for (const GpuActors::Placed& one : picked_) actors.DrawDepth(one, W_from_A_);
  moving_.EndDrawing();
}

bool Shadows::MayFallOn(const Eigen::AlignedBox3d& box) const {
  if (box.isEmpty()) return false;
  return std::any_of(casters_.begin(), casters_.end(), [&](const BoundingSphere& caster) {
    const Eigen::Vector2d nearest =
        caster.center.head<2>().cwiseMax(box.min().head<2>()).cwiseMin(box.max().head<2>());
    return (caster.center.head<2>() - nearest).norm() < caster.radius_m &&
           caster.center.z() + caster.radius_m > box.min().z();
  });
}

}  // namespace polnav::sim
