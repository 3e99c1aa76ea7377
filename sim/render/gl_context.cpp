#include "sim/render/gl_context.h"

#include <cstdlib>
#include <mutex>
#include <stdexcept>
#include <string>

namespace polnav::sim {
namespace {

constexpr int kSurfaceSide = 8;

std::mutex& LlvmpipeMutex() {
  static std::mutex mutex;
  return mutex;
}

OSMesaContext CreateContext() {
  // Read once, when Mesa makes the process's first context.
  static std::once_flag once;
  std::call_once(once, [] { setenv("LP_NUM_THREADS", "0", 1); });
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            3,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            3,
                            0};
  OSMesaContext context = OSMesaCreateContextAttribs(attributes, nullptr);
  if (context == nullptr) throw std::runtime_error("OSMesa gives no OpenGL 3.3 core context");
  return context;
}

GLuint CompileShader(const GlFunctions& gl, GLenum kind, const char* source) {
  const GLuint shader = gl.CreateShader(kind);
  const char* const parts[] = {"#version 330 core\n", source};
  gl.ShaderSource(shader, 2, parts, nullptr);
  gl.CompileShader(shader);
  GLint ok = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok == 0) {
    std::string log(4096, '\0');
    gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::logic_error("shader does not compile: " + log);
  }
  return shader;
}

}  // namespace

GlTurn::GlTurn() : lock_(LlvmpipeMutex()) {}

GlContext::GlContext()
    : context_(CreateContext()), surface_(std::size_t{4} * kSurfaceSide * kSurfaceSide) {
  MakeCurrent();
#define POLNAV_GL_LOAD(name)                                                         \
  gl_.name = reinterpret_cast<decltype(gl_.name)>(OSMesaGetProcAddress("gl" #name)); \
  if (gl_.name == nullptr) throw std::runtime_error("OSMesa lacks gl" #name);
  POLNAV_GL_FUNCTIONS(POLNAV_GL_LOAD)
#undef POLNAV_GL_LOAD
}

void GlContext::MakeCurrent() {
  if (OSMesaGetCurrentContext() == context_.get()) return;
  if (OSMesaMakeCurrent(context_.get(), surface_.data(), GL_UNSIGNED_BYTE, kSurfaceSide,
                        kSurfaceSide) == GL_FALSE) {
    throw std::runtime_error("OSMesa cannot make its context current");
  }
}

GLuint GlContext::LinkProgram(const char* vertex_source, const char* fragment_source) const {
  const GLuint program = gl_.CreateProgram();
  gl_.AttachShader(program, CompileShader(gl_, GL_VERTEX_SHADER, vertex_source));
  gl_.AttachShader(program, CompileShader(gl_, GL_FRAGMENT_SHADER, fragment_source));
  gl_.LinkProgram(program);
  GLint ok = 0;
  gl_.GetProgramiv(program, GL_LINK_STATUS, &ok);
  if (ok == 0) {
    std::string log(4096, '\0');
    gl_.GetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::logic_error("shader program does not link: " + log);
  }
  return program;
}

}  // namespace polnav::sim
