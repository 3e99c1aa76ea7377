#include "sim/render/renderer.h"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/render/frustum.h"
#include "sim/render/gl_context.h"
#include "sim/render/gpu_actors.h"
#include "sim/render/gpu_scene.h"
#include "sim/render/lighting.h"
#include "sim/render/shaders.h"
#include "sim/render/shadows.h"
#include "sim/render/sky_dome.h"
#include "sim/render/surface_programs.h"
#include "sim/world/fog.h"

namespace polnav::sim {
namespace {

std::vector<GpuTriangles::Vertex> VerticesOf(const SkyDome& dome) {
  std::vector<GpuTriangles::Vertex> vertices;
  for (const SkyDome::Vertex& v : dome.vertices) vertices.push_back({v.direction_W, v.radiance});
  return vertices;
}

// At the near plane, so that nothing behind is shaded.
GpuTriangles LoadMask(const GlFunctions& gl, const std::vector<Eigen::Vector2d>& triangles_px,
                      const PinholeView& view) {
  std::vector<GpuTriangles::Vertex> vertices;
  std::vector<std::uint32_t> indices;
  for (const Eigen::Vector2d& p : triangles_px) {
    const Eigen::Vector3d clip(2.0 * (p.x() + 0.5) / view.width_px - 1.0,
                               2.0 * (p.y() + 0.5) / view.height_px - 1.0, -1.0);
    indices.push_back(static_cast<std::uint32_t>(vertices.size()));
    vertices.push_back({clip.cast<float>(), 0.0F});
  }
  return {gl, vertices, indices};
}

StandingLight StandingLightOf(const Lighting& lighting) {
  return {.sun_W = lighting.sun_W().cast<float>(),
          .sun = static_cast<float>(lighting.sun()),
          .harmonics = lighting.SkyHarmonics()};
}

}  // namespace

struct Renderer::Impl {
  Impl(const Scene& scene, const sky::WorldSky& sky, const PinholeView& pinhole_view,
       const std::vector<Eigen::Vector2d>& unneeded_px, const std::optional<CloseUp>& close_up_in);

  void Draw(const RenderRequest& request);
  void Read(int type, GLenum gl_type, cv::Mat& image) const;
  void MakeFramebuffer();
  void MoveClouds(nav::TimeNs stamp);
  [[nodiscard]] PictureLight LightOf(const RenderRequest& request, const nav::Pose& T_CW) const;
  void DrawMask();
  void DrawSurfaces(const PictureLight& light, const SurfaceNeeds& needs);
  void DrawActors(const std::vector<GpuActors::Placed>& placed, const nav::Pose& T_CW,
                  const PictureLight& light, SurfaceNeeds needs);
  void DrawSky(const nav::Pose& T_CW, const PictureLight& light);

  GlContext context;
  const GlFunctions& gl;
  sky::WorldSky sky;
  PinholeView view;
  std::optional<CloseUp> close_up;
  Frustum frustum;
  Lighting lighting;
  SkyDome dome;
  nav::TimeNs dome_second = 0;
  SurfacePrograms programs;
  GLuint sky_program;
  GLuint mask_program;
  std::vector<GLuint> textures;
  Shadows shadows;
  GpuScene surfaces;
  GpuActors actors;
  GpuTriangles gpu_dome;
  GpuTriangles mask;
  GLuint grain = 0;
  GLuint framebuffer = 0;
};

Renderer::Impl::Impl(const Scene& scene, const sky::WorldSky& world_sky,
                     const PinholeView& pinhole_view,
                     const std::vector<Eigen::Vector2d>& unneeded_px,
                     const std::optional<CloseUp>& close_up_in)
    : gl(context.gl()),
      sky(world_sky),
      view(pinhole_view),
      close_up(close_up_in),
      frustum(pinhole_view),
      lighting(sky),
      dome(BuildSkyDome(sky)),
      programs(context, StandingLightOf(lighting)),
      sky_program(context.LinkProgram(kSkyVertexShader, kPlainFragmentShader)),
      mask_program(context.LinkProgram(kMaskVertexShader, kPlainFragmentShader)),
      textures(LoadTextures(gl, scene.textures)),
      shadows(context, scene, lighting.sun_W()),
      surfaces(gl, scene, textures, lighting, SunLitTriangles(shadows.standing())),
      actors(gl, scene.actors, textures),
      gpu_dome(gl, VerticesOf(dome), dome.indices),
      mask(LoadMask(gl, unneeded_px, view)) {
  if (close_up) grain = LoadGrain(gl);
  MakeFramebuffer();
  gl.CullFace(GL_BACK);
  gl.FrontFace(GL_CW);  // rows run down the image, which mirrors every triangle
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LEQUAL);  // the dome is at the far plane, where Clear put the depth
  if (gl.GetError() != GL_NO_ERROR) throw std::runtime_error("OpenGL cannot load the scene");
}

void Renderer::Impl::MakeFramebuffer() {
  GLuint color_depth[2];
  gl.GenFramebuffers(1, &framebuffer);
  gl.GenRenderbuffers(2, color_depth);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  gl.BindRenderbuffer(GL_RENDERBUFFER, color_depth[0]);
  gl.RenderbufferStorage(GL_RENDERBUFFER, close_up ? GL_R32F : GL_R8, view.width_px,
                         view.height_px);
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color_depth[0]);
  gl.BindRenderbuffer(GL_RENDERBUFFER, color_depth[1]);
  gl.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, view.width_px, view.height_px);
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, color_depth[1]);
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error("OSMesa gives no frame buffer of " + std::to_string(view.width_px) +
                             " x " + std::to_string(view.height_px) + " pixels");
  }
}

// The sky of the second that the stamp lies in: the same in whatever order pictures are drawn.
void Renderer::Impl::MoveClouds(nav::TimeNs stamp) {
  const nav::TimeNs second = stamp / nav::kNsPerSecond;
  if (second == dome_second) return;
  dome_second = second;
  UpdateRadiance(sky, static_cast<double>(second), dome);
  gpu_dome.Update(VerticesOf(dome));
}

PictureLight Renderer::Impl::LightOf(const RenderRequest& request, const nav::Pose& T_CW) const {
  Eigen::Matrix4d C_from_W = Eigen::Matrix4d::Identity();
  C_from_W.topLeftCorner<3, 3>() = T_CW.q.toRotationMatrix();
  if (!close_up) C_from_W.topRightCorner<3, 1>() = T_CW.p;
  const double sun_share =
      lighting.sun() > 0.0
          ? sky.Transmittance(lighting.sun_W(), request.T_WC.p, nav::ToSeconds(request.stamp))
          : 1.0;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const double fallen = lighting.FromSky(up) + sun_share * lighting.FromSun(up);
  return {.clip_from_W = (ProjectionMatrix(view) * C_from_W).cast<float>(),
          .sun_map_from_W = shadows.standing().map_from_W(),
          .actor_map_from_W = shadows.moving().map_from_W(),
          .eye_W = request.T_WC.p.cast<float>(),
          .exposure = static_cast<float>(request.exposure),
          .sun_share = static_cast<float>(sun_share),
          .extinction_1_m = static_cast<float>(FogExtinction(request.visibility_m)),
          .airlight = static_cast<float>(FogRadiance(fallen, request.visibility_m)),
          .grain = close_up ? GrainSeenFrom(request.T_WC.p, *close_up) : GrainAtEye{}};
}

void Renderer::Impl::DrawMask() {
  gl.Disable(GL_CULL_FACE);
  gl.UseProgram(mask_program);
  mask.Draw();
  gl.Enable(GL_CULL_FACE);
}

void Renderer::Impl::DrawSurfaces(const PictureLight& light, const SurfaceNeeds& needs) {
  for (const bool by_actors : {false, true}) {
    if (by_actors && !needs.actor_shadow) continue;
    const auto wanted = [&](const Eigen::AlignedBox3d& sun_box) {
      return (needs.actor_shadow && shadows.MayFallOn(sun_box)) == by_actors;
    };
    programs.Use({.actor_shadow = by_actors, .fog = needs.fog, .close_up = needs.close_up}, light);
    surfaces.Draw(GpuScene::Part::kPlain, wanted);
    programs.Use({.sun_shadow = true,
                  .actor_shadow = by_actors,
                  .fog = needs.fog,
                  .close_up = needs.close_up},
                 light);
    surfaces.Draw(GpuScene::Part::kShadowEdge, wanted);
  }
}

void Renderer::Impl::DrawActors(const std::vector<GpuActors::Placed>& placed, const nav::Pose& T_CW,
                                const PictureLight& light, SurfaceNeeds needs) {
  needs.actor = true;
  needs.sun_shadow = true;
  bool in_use = false;
  for (const GpuActors::Placed& one : placed) {
    if (!frustum.MayShow(T_CW * one.sphere.center, one.sphere.radius_m)) continue;
    if (!in_use) programs.Use(needs, light);
    in_use = true;
    actors.Draw(one, programs);
  }
}

void Renderer::Impl::DrawSky(const nav::Pose& T_CW, const PictureLight& light) {
  const auto at = [&](const char* name) { return gl.GetUniformLocation(sky_program, name); };
  gl.Disable(GL_CULL_FACE);
  gl.UseProgram(sky_program);
  gl.UniformMatrix4fv(at("clip_from_W"), 1, GL_FALSE, light.clip_from_W.data());
  gl.Uniform1f(at("exposure"), light.exposure);
  gl.Uniform1f(at("fog_depth"), light.extinction_1_m * static_cast<float>(kFogThickness_m));
  gl.Uniform1f(at("airlight"), light.exposure * light.airlight);
  for (const SkyDome::Patch& patch : dome.patches) {
    if (!frustum.MayShowDirections(T_CW.q * patch.direction_W, patch.radius_rad)) continue;
    gpu_dome.Draw(patch.first, patch.count);
  }
}

Renderer::Renderer(const Scene& scene, const sky::WorldSky& sky, const PinholeView& view,
                   const std::vector<Eigen::Vector2d>& unneeded_px) {
  const GlTurn turn;
  impl_ = std::make_unique<Impl>(scene, sky, view, unneeded_px, std::nullopt);
}

Renderer::Renderer(const Scene& scene, const sky::WorldSky& sky, const PinholeView& view,
                   const CloseUp& close_up) {
  const GlTurn turn;
  impl_ = std::make_unique<Impl>(scene, sky, view, std::vector<Eigen::Vector2d>(), close_up);
}

Renderer::~Renderer() {
  const GlTurn turn;
  impl_.reset();
}

void Renderer::Impl::Draw(const RenderRequest& request) {
  context.MakeCurrent();
  MoveClouds(request.stamp);
  const std::vector<GpuActors::Placed> placed = actors.At(request.stamp);
  const nav::Pose T_CW = request.T_WC.Inverse();
  surfaces.Cull(T_CW, frustum);
  shadows.Pick(placed, request.stamp, request.T_WC.p);
  const bool by_actors =
      surfaces.Any([&](const Eigen::AlignedBox3d& box) { return shadows.MayFallOn(box); });
  if (by_actors) shadows.DrawPicked(actors);
  shadows.standing().Bind(kSunMapUnit);
  shadows.moving().Bind(kActorMapUnit);

  const PictureLight light = LightOf(request, T_CW);
  const bool fog = light.extinction_1_m > 0.0F;
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  gl.Viewport(0, 0, view.width_px, view.height_px);
  gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  DrawMask();
  const SurfaceNeeds needs{.actor_shadow = by_actors, .fog = fog, .close_up = close_up.has_value()};
  if (close_up) {
    gl.ActiveTexture(kGrainUnit);
    gl.BindTexture(GL_TEXTURE_2D, grain);
    gl.ActiveTexture(GL_TEXTURE0);
  }
  DrawActors(placed, T_CW, light, needs);
  DrawSurfaces(light, needs);
  DrawSky(T_CW, light);
}

void Renderer::Impl::Read(int type, GLenum gl_type, cv::Mat& image) const {
  image.create(view.height_px, view.width_px, type);
  gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl.PixelStorei(GL_PACK_ROW_LENGTH, static_cast<GLint>(image.step1()));
  gl.ReadPixels(0, 0, view.width_px, view.height_px, GL_RED, gl_type, image.data);
}

void Renderer::Render(const RenderRequest& request, cv::Mat& image) {
  const GlTurn turn;
  if (impl_->close_up) throw std::logic_error("Renderer: a close-up gives radiance");
  impl_->Draw(request);
  impl_->Read(CV_8UC1, GL_UNSIGNED_BYTE, image);
}

void Renderer::RenderRadiance(const RenderRequest& request, cv::Mat& image) {
  const GlTurn turn;
  if (!impl_->close_up) throw std::logic_error("Renderer: only a close-up gives radiance");
  impl_->Draw(request);
  impl_->Read(CV_32FC1, GL_FLOAT, image);
}

}  // namespace polnav::sim
