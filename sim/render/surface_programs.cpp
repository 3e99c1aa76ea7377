#include "sim/render/surface_programs.h"

#include <string>

#include "sim/render/shaders.h"

namespace polnav::sim {

SurfacePrograms::SurfacePrograms(const GlContext& context, const StandingLight& light)
    : context_(context), light_(light) {}

SurfacePrograms::Program SurfacePrograms::Link(const SurfaceNeeds& needs) const {
  std::string variant;
  if (needs.actor) variant += "#define ACTOR\n";
  if (needs.sun_shadow) variant += "#define SUN_SHADOW\n";
  if (needs.actor_shadow) variant += "#define ACTOR_SHADOW\n";
  if (needs.fog) variant += "#define FOG\n";
  if (needs.close_up) variant += "#define CLOSE_UP\n";
  const GlFunctions& gl = context_.gl();
  const GLuint id = context_.LinkProgram((variant + kSurfaceVertexShader).c_str(),
                                         (variant + kSurfaceFragmentShader).c_str());
  const auto at = [&](const char* name) { return gl.GetUniformLocation(id, name); };
  gl.UseProgram(id);
  gl.Uniform1i(at("reflectance"), 0);
  gl.Uniform1i(at("sun_map"), static_cast<GLint>(kSunMapUnit - GL_TEXTURE0));
  gl.Uniform1i(at("actor_map"), static_cast<GLint>(kActorMapUnit - GL_TEXTURE0));
  gl.Uniform1i(at("grain"), static_cast<GLint>(kGrainUnit - GL_TEXTURE0));
  gl.Uniform3f(at("sun_W"), light_.sun_W.x(), light_.sun_W.y(), light_.sun_W.z());
  gl.Uniform1f(at("sun"), light_.sun);
  gl.Uniform1fv(at("harmonics"), 9, light_.harmonics.data());
  return {id, at("W_from_A")};
}

void SurfacePrograms::Use(const SurfaceNeeds& needs, const PictureLight& light) {
  Program& program = programs_[(needs.actor ? 1U : 0U) + (needs.sun_shadow ? 2U : 0U) +
                               (needs.actor_shadow ? 4U : 0U) + (needs.fog ? 8U : 0U) +
                               (needs.close_up ? 16U : 0U)];
  if (program.id == 0) program = Link(needs);
  const GlFunctions& gl = context_.gl();
  gl.UseProgram(program.id);
  const auto at = [&](const char* name) { return gl.GetUniformLocation(program.id, name); };
  gl.UniformMatrix4fv(at("clip_from_W"), 1, GL_FALSE, light.clip_from_W.data());
  gl.UniformMatrix4fv(at("sun_map_from_W"), 1, GL_FALSE, light.sun_map_from_W.data());
  gl.UniformMatrix4fv(at("actor_map_from_W"), 1, GL_FALSE, light.actor_map_from_W.data());
  gl.Uniform3f(at("eye_W"), light.eye_W.x(), light.eye_W.y(), light.eye_W.z());
  gl.Uniform1f(at("exposure"), light.exposure);
  gl.Uniform1f(at("sun_share"), light.sun_share);
  gl.Uniform1f(at("extinction"), light.extinction_1_m);
  gl.Uniform1f(at("airlight"), light.exposure * light.airlight);
  if (needs.close_up) SetGrain(program.id, light.grain);
  W_from_A_ = program.W_from_A;
}

void SurfacePrograms::SetGrain(GLuint program, const GrainAtEye& grain) const {
  const GlFunctions& gl = context_.gl();
  const auto at = [&](const char* name) { return gl.GetUniformLocation(program, name); };
  const auto set = [&](const char* name, const Eigen::Vector3f& v) {
    gl.Uniform3f(at(name), v.x(), v.y(), v.z());
  };
  set("eye_rest_W", grain.eye_rest_W);
  set("fine_at_eye", {grain.fine_at_eye.x(), grain.fine_at_eye.y(), 0.0F});
  set("coarse_at_eye", {grain.coarse_at_eye.x(), grain.coarse_at_eye.y(), 0.0F});
  set("coarse_per_m", {grain.coarse_per_m.x(), grain.coarse_per_m.y(), 0.0F});
  gl.Uniform1f(at("fine_per_m"), grain.fine_per_m);
  gl.Uniform1f(at("grain_gain"), grain.gain);
}

void SurfacePrograms::Place(const Eigen::Matrix4f& W_from_A) const {
  context_.gl().UniformMatrix4fv(W_from_A_, 1, GL_FALSE, W_from_A.data());
}

}  // namespace polnav::sim
