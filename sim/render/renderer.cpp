#include "sim/render/renderer.h"

#include <stdexcept>
#include <string>
#include <vector>

#include "sim/render/frustum.h"
#include "sim/render/gl_context.h"
#include "sim/render/gpu_scene.h"
#include "sim/render/lighting.h"
#include "sim/render/shaders.h"

namespace polnav::sim {
namespace {

GpuTriangles LoadSky(const GlFunctions& gl, const sky::WorldSky& sky) {
  const SkyDome dome = BuildSkyDome(sky);
  std::vector<GpuTriangles::Vertex> vertices;
  for (const SkyDome::Vertex& v : dome.vertices) vertices.push_back({v.direction_W, v.radiance});
  return {gl, vertices, dome.indices};
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

}  // namespace

struct Renderer::Impl {
  Impl(const Scene& scene, const sky::WorldSky& sky, const PinholeView& pinhole_view,
       const std::vector<Eigen::Vector2d>& unneeded_px);

  struct Program {
    GLuint id = 0;
    GLint clip_from_W = -1;
    GLint exposure = -1;
  };
  [[nodiscard]] Program Link(const char* vertex, const char* fragment) const;
  void Use(const Program& program, const Eigen::Matrix4f& clip_from_W, double exposure) const;
  void MakeFramebuffer() const;

  GlContext context;
  const GlFunctions& gl;
  PinholeView view;
  Frustum frustum;
  Program surface_program;
  Program sky_program;
  Program mask_program;
  GpuScene surfaces;
  GpuTriangles dome;
  GpuTriangles mask;
};

Renderer::Impl::Impl(const Scene& scene, const sky::WorldSky& sky, const PinholeView& pinhole_view,
                     const std::vector<Eigen::Vector2d>& unneeded_px)
    : gl(context.gl()),
      view(pinhole_view),
      frustum(pinhole_view),
      surface_program(Link(kSurfaceVertexShader, kSurfaceFragmentShader)),
      sky_program(Link(kSkyVertexShader, kPlainFragmentShader)),
      mask_program(Link(kMaskVertexShader, kPlainFragmentShader)),
      surfaces(gl, scene, Lighting(sky)),
      dome(LoadSky(gl, sky)),
      mask(LoadMask(gl, unneeded_px, view)) {
  MakeFramebuffer();
  gl.CullFace(GL_BACK);
  gl.FrontFace(GL_CW);  // rows run down the image, which mirrors every triangle
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LEQUAL);  // the dome is at the far plane, where Clear put the depth
  gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
  if (gl.GetError() != GL_NO_ERROR) throw std::runtime_error("OpenGL cannot load the scene");
}

Renderer::Impl::Program Renderer::Impl::Link(const char* vertex, const char* fragment) const {
  const GLuint id = context.LinkProgram(vertex, fragment);
  return {id, gl.GetUniformLocation(id, "clip_from_W"), gl.GetUniformLocation(id, "exposure")};
}

void Renderer::Impl::Use(const Program& program, const Eigen::Matrix4f& clip_from_W,
                         double exposure) const {
  gl.UseProgram(program.id);
  gl.UniformMatrix4fv(program.clip_from_W, 1, GL_FALSE, clip_from_W.data());
  gl.Uniform1f(program.exposure, static_cast<float>(exposure));
}

void Renderer::Impl::MakeFramebuffer() const {
  GLuint framebuffer = 0;
  GLuint color_depth[2];
  gl.GenFramebuffers(1, &framebuffer);
  gl.GenRenderbuffers(2, color_depth);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  gl.BindRenderbuffer(GL_RENDERBUFFER, color_depth[0]);
  gl.RenderbufferStorage(GL_RENDERBUFFER, GL_R8, view.width_px, view.height_px);
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color_depth[0]);
  gl.BindRenderbuffer(GL_RENDERBUFFER, color_depth[1]);
  gl.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, view.width_px, view.height_px);
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, color_depth[1]);
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error("OSMesa gives no frame buffer of " + std::to_string(view.width_px) +
                             " x " + std::to_string(view.height_px) + " pixels");
  }
  gl.Viewport(0, 0, view.width_px, view.height_px);
}

Renderer::Renderer(const Scene& scene, const sky::WorldSky& sky, const PinholeView& view,
                   const std::vector<Eigen::Vector2d>& unneeded_px)
    : impl_(std::make_unique<Impl>(scene, sky, view, unneeded_px)) {}

Renderer::~Renderer() = default;

void Renderer::Render(const nav::Pose& T_WC, double exposure, cv::Mat& image) {
  Impl& r = *impl_;
  r.context.MakeCurrent();
  const nav::Pose T_CW = T_WC.Inverse();
  Eigen::Matrix4d C_from_W = Eigen::Matrix4d::Identity();
  C_from_W.topLeftCorner<3, 3>() = T_CW.q.toRotationMatrix();
  C_from_W.topRightCorner<3, 1>() = T_CW.p;
  const Eigen::Matrix4f clip_from_W = (ProjectionMatrix(r.view) * C_from_W).cast<float>();

  r.gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  r.gl.Disable(GL_CULL_FACE);
  r.gl.UseProgram(r.mask_program.id);
  r.mask.Draw();
  r.gl.Enable(GL_CULL_FACE);
  r.Use(r.surface_program, clip_from_W, exposure);
  r.surfaces.Draw(T_CW, r.frustum);
  r.gl.Disable(GL_CULL_FACE);
  r.Use(r.sky_program, clip_from_W, exposure);
  r.dome.Draw();

  image.create(r.view.height_px, r.view.width_px, CV_8UC1);
  r.gl.PixelStorei(GL_PACK_ROW_LENGTH, static_cast<GLint>(image.step1()));
  r.gl.ReadPixels(0, 0, r.view.width_px, r.view.height_px, GL_RED, GL_UNSIGNED_BYTE, image.data);
}

}  // namespace polnav::sim
