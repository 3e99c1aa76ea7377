// How do vertices get into the renderer's memory?
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/render/gl_context.h"

namespace polnav::sim {

inline const void* BufferOffset(std::size_t bytes) { return reinterpret_cast<const void*>(bytes); }

struct GpuBuffers {
  GLuint array = 0;     // vertex array, bound when made
  GLuint vertices = 0;  // its vertex buffer
};

// A vertex array with its two buffers bound and filled.
template <typename V>
GpuBuffers LoadBuffers(const GlFunctions& gl, const std::vector<V>& vertices,
                       const std::vector<std::uint32_t>& indices) {
  GLuint array = 0;
  GLuint buffers[2];
  gl.GenVertexArrays(1, &array);
  gl.GenBuffers(2, buffers);
  gl.BindVertexArray(array);
  gl.BindBuffer(GL_ARRAY_BUFFER, buffers[0]);
  gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(V)),
                vertices.data(), GL_STATIC_DRAW);
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
  gl.BufferData(GL_ELEMENT_ARRAY_BUFFER,
                static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)), indices.data(),
                GL_STATIC_DRAW);
  return {array, buffers[0]};
}

// Of the vertex array that is bound: `components` floats of every vertex.
inline void Attribute(const GlFunctions& gl, GLuint location, GLint components, std::size_t stride,
                      std::size_t offset) {
  gl.EnableVertexAttribArray(location);
  gl.VertexAttribPointer(location, components, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                         BufferOffset(offset));
}

inline void DrawIndexed(const GlFunctions& gl, std::size_t first_index, std::size_t count) {
  gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(count), GL_UNSIGNED_INT,
                  BufferOffset(first_index * sizeof(std::uint32_t)));
}

}  // namespace polnav::sim
