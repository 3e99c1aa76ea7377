// Where does OpenGL come from without a display?
//
// OSMesa's llvmpipe: OpenGL 3.3 core, rasterized in the calling thread, so that the bytes depend
// neither on the number of cores nor on who else is drawing.
//
// Threads take turns (GlTurn), each with a context of its own: all contexts of a process share
// one llvmpipe, and whenever one of them binds or reads a texture, llvmpipe looks for it in the
// scenes of all the others while their threads fill and free them (llvmpipe_flush_resource in Mesa
// 22.3 locks the list of contexts, not what they hold). Rasterizing is behind a lock of Mesa's own
// in any case.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/osmesa.h>

#include <memory>
#include <mutex>
#include <vector>

namespace polnav::sim {

// clang-format off
#define POLNAV_GL_FUNCTIONS(X) \
  X(ActiveTexture) X(AttachShader) X(BindBuffer) X(BindFramebuffer) X(BindRenderbuffer) \
  X(BindTexture) X(BindVertexArray) X(BufferData) X(BufferSubData) X(CheckFramebufferStatus) \
  X(Clear) X(CompileShader) X(CreateProgram) X(CreateShader) X(CullFace) X(DeleteBuffers) \
  X(DeleteVertexArrays) X(DepthFunc) X(Disable) X(DrawBuffer) X(DrawElements) X(Enable) \
  X(EnableVertexAttribArray) X(FramebufferRenderbuffer) X(FramebufferTexture2D) X(FrontFace) \
  X(GenBuffers) X(GenFramebuffers) X(GenRenderbuffers) X(GenTextures) X(GenVertexArrays) \
  X(GenerateMipmap) X(GetError) X(GetProgramInfoLog) X(GetProgramiv) X(GetShaderInfoLog) \
  X(GetShaderiv) X(GetUniformLocation) X(LinkProgram) X(MultiDrawElements) X(PixelStorei) X(PolygonOffset) \
  X(ReadBuffer) X(ReadPixels) X(RenderbufferStorage) X(ShaderSource) X(TexImage2D) \
  X(TexParameterf) X(TexParameteri) X(Uniform1f) X(Uniform1fv) X(Uniform1i) X(Uniform3f) \
  X(UniformMatrix4fv) X(UseProgram) X(VertexAttribPointer) X(Viewport)
// clang-format on

// gl.Clear(...) is glClear(...).
struct GlFunctions {
#define POLNAV_GL_MEMBER(name) decltype(&::gl##name) name = nullptr;
  POLNAV_GL_FUNCTIONS(POLNAV_GL_MEMBER)
#undef POLNAV_GL_MEMBER
};

// While one lives, no other thread has one. The process's, as is the llvmpipe that it guards.
class GlTurn {
 public:
  GlTurn();

 private:
  std::lock_guard<std::mutex> lock_;
};

// All that is done with it, from its construction to its end, needs a GlTurn.
class GlContext {
 public:
  GlContext();

  // Everything after this call in this thread goes to this context.
  void MakeCurrent();

  [[nodiscard]] const GlFunctions& gl() const { return gl_; }
  // Vertex and fragment source, without their version, to a linked program.
  [[nodiscard]] GLuint LinkProgram(const char* vertex_source, const char* fragment_source) const;

 private:
  struct Destroy {
    void operator()(osmesa_context* context) const { OSMesaDestroyContext(context); }
  };
  std::unique_ptr<osmesa_context, Destroy> context_;
  std::vector<unsigned char> surface_;  // OSMesa wants one; we draw into framebuffer objects
  GlFunctions gl_;
};

}  // namespace polnav::sim
