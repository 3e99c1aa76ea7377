// What happens to a vertex and to a pixel? As little as possible: llvmpipe pays for every fetch.
#pragma once

namespace polnav::sim {

// Light is baked into the vertices when the scene is loaded: the sun stands still.
inline constexpr const char* kSurfaceVertexShader = R"(#version 330 core
layout(location = 0) in vec3 p_W;
layout(location = 1) in vec2 uv;
layout(location = 2) in float light;
uniform mat4 clip_from_W;
uniform float exposure;
out vec2 texture_uv;
out float grey;
void main() {
  gl_Position = clip_from_W * vec4(p_W, 1.0);
  texture_uv = uv;
  grey = exposure * light;
}
)";

inline constexpr const char* kSurfaceFragmentShader = R"(#version 330 core
in vec2 texture_uv;
in float grey;
uniform sampler2D reflectance;
layout(location = 0) out vec4 color;
void main() { color = vec4(texture(reflectance, texture_uv).r * grey); }
)";

// The dome is at infinity: only the camera's rotation moves it, and depth is the far plane's.
inline constexpr const char* kSkyVertexShader = R"(#version 330 core
layout(location = 0) in vec3 direction_W;
layout(location = 1) in float radiance;
uniform mat4 clip_from_W;
uniform float exposure;
out float grey;
void main() {
  gl_Position = (clip_from_W * vec4(direction_W, 0.0)).xyww;
  grey = exposure * radiance;
}
)";

// Already in clip coordinates.
inline constexpr const char* kMaskVertexShader = R"(#version 330 core
layout(location = 0) in vec3 p_clip;
layout(location = 1) in float radiance;
out float grey;
void main() {
  gl_Position = vec4(p_clip, 1.0);
  grey = radiance;
}
)";

inline constexpr const char* kPlainFragmentShader = R"(#version 330 core
in float grey;
layout(location = 0) out vec4 color;
void main() { color = vec4(grey); }
)";

}  // namespace polnav::sim
