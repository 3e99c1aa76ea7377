// What happens to a vertex and to a pixel? As little as possible: llvmpipe pays for every fetch.
#pragma once

namespace polnav::sim {

// Compiled in variants (surface_programs.h):
//   ACTOR        lit here instead of when the scene is loaded: it turns
//   SUN_SHADOW   shadows of what stands still may end within the triangle
//   ACTOR_SHADOW shadows of what moves may fall on it
//   FOG
//   CLOSE_UP     places are relative to the eye, to a float's last bit near it, and surfaces have
//                a grain
// light: from sky and from sun, times albedo.
inline constexpr const char* kSurfaceVertexShader = R"(
layout(location = 0) in vec3 p;
layout(location = 1) in vec2 uv;
uniform mat4 clip_from_W;
uniform float exposure;
uniform float sun_share;
out vec2 texture_uv;
#ifdef ACTOR
layout(location = 2) in float albedo;
layout(location = 3) in vec3 normal;
uniform mat4 W_from_A;
uniform vec3 sun_W;
uniform float sun;
uniform float harmonics[9];
#else
layout(location = 2) in vec2 light;
#endif
#if defined(SUN_SHADOW) || defined(ACTOR_SHADOW)
out float sky_grey;
out float sun_grey;
#else
out float grey;
#endif
#ifdef SUN_SHADOW
uniform mat4 sun_map_from_W;
out vec3 in_sun_map;
#endif
#ifdef ACTOR_SHADOW
uniform mat4 actor_map_from_W;
out vec3 in_actor_map;
#endif
#if defined(FOG) || defined(CLOSE_UP)
uniform vec3 eye_W;
#endif
#ifdef FOG
out vec3 from_eye;
#endif
#ifdef CLOSE_UP
uniform vec3 eye_rest_W;
uniform vec3 fine_at_eye;
uniform vec3 coarse_at_eye;
uniform float fine_per_m;
uniform vec3 coarse_per_m;
out vec2 fine_uv;
out vec2 coarse_uv;
#endif
void main() {
#ifdef ACTOR
  vec4 p_W = W_from_A * vec4(p, 1.0);
  vec3 n = mat3(W_from_A) * normal;
  float from_sky = harmonics[0] + dot(vec3(harmonics[1], harmonics[2], harmonics[3]), n) +
                   harmonics[4] * n.x * n.y + harmonics[5] * n.y * n.z +
                   harmonics[6] * n.x * n.z + harmonics[7] * (n.x * n.x - n.y * n.y) +
                   harmonics[8] * (3.0 * n.z * n.z - 1.0);
  vec2 light = albedo * vec2(from_sky, sun * max(0.0, dot(n, sun_W)));
#else
  vec4 p_W = vec4(p, 1.0);
#endif
#ifdef CLOSE_UP
  vec3 near = (p_W.xyz - eye_W) - eye_rest_W;
  gl_Position = clip_from_W * vec4(near, 1.0);
  fine_uv = fine_at_eye.xy + fine_per_m * near.xy;
  coarse_uv = coarse_at_eye.xy + vec2(dot(coarse_per_m.xy, near.xy),
                                      coarse_per_m.x * near.y - coarse_per_m.y * near.x);
#else
  gl_Position = clip_from_W * p_W;
#endif
  texture_uv = uv;
#if defined(SUN_SHADOW) || defined(ACTOR_SHADOW)
  sky_grey = exposure * light.x;
  sun_grey = exposure * sun_share * light.y;
#else
  grey = exposure * (light.x + sun_share * light.y);
#endif
#ifdef SUN_SHADOW
  in_sun_map = (sun_map_from_W * p_W).xyz;
#endif
#ifdef ACTOR_SHADOW
  in_actor_map = (actor_map_from_W * p_W).xyz;
#endif
#ifdef FOG
  from_eye = p_W.xyz - eye_W;
#endif
}
)";

inline constexpr const char* kSurfaceFragmentShader = R"(
in vec2 texture_uv;
uniform sampler2D reflectance;
#if defined(SUN_SHADOW) || defined(ACTOR_SHADOW)
in float sky_grey;
in float sun_grey;
#else
in float grey;
#endif
#ifdef SUN_SHADOW
in vec3 in_sun_map;
uniform sampler2DShadow sun_map;
#endif
#ifdef ACTOR_SHADOW
in vec3 in_actor_map;
uniform sampler2DShadow actor_map;
#endif
#ifdef FOG
in vec3 from_eye;
uniform float extinction;
uniform float airlight;
#endif
#ifdef CLOSE_UP
in vec2 fine_uv;
in vec2 coarse_uv;
uniform sampler2D grain;
uniform float grain_gain;
#endif
layout(location = 0) out vec4 color;
void main() {
#if defined(SUN_SHADOW) || defined(ACTOR_SHADOW)
  float sun_lit = 1.0;
#ifdef SUN_SHADOW
  sun_lit = min(sun_lit, texture(sun_map, in_sun_map));
#endif
#ifdef ACTOR_SHADOW
  sun_lit = min(sun_lit, texture(actor_map, in_actor_map));
#endif
  float grey = sky_grey + sun_lit * sun_grey;
#endif
  float seen = texture(reflectance, texture_uv).r * grey;
#ifdef CLOSE_UP
  float grains = texture(grain, fine_uv).r + texture(grain, coarse_uv).r - 1.0;
  seen *= max(0.0, 1.0 + grain_gain * grains);
#endif
#ifdef FOG
  seen = mix(airlight, seen, exp(-extinction * length(from_eye)));
#endif
  color = vec4(seen);
}
)";

// The dome is at infinity: only the camera's rotation moves it, and depth is the far plane's. A fog
// is a layer above the eye, which a ray near the horizon takes long to leave.
inline constexpr const char* kSkyVertexShader = R"(
layout(location = 0) in vec3 direction_W;
layout(location = 1) in float radiance;
uniform mat4 clip_from_W;
uniform float exposure;
uniform float fog_depth;
uniform float airlight;
out float grey;
void main() {
  gl_Position = (clip_from_W * vec4(direction_W, 0.0)).xyww;
  grey = mix(airlight, exposure * radiance, exp(-fog_depth / max(direction_W.z, 0.01)));
}
)";

// Already in clip coordinates.
inline constexpr const char* kMaskVertexShader = R"(
layout(location = 0) in vec3 p_clip;
layout(location = 1) in float radiance;
out float grey;
void main() {
  gl_Position = vec4(p_clip, 1.0);
  grey = radiance;
}
)";

inline constexpr const char* kPlainFragmentShader = R"(
in float grey;
layout(location = 0) out vec4 color;
void main() { color = vec4(grey); }
)";

// Into a shadow map: depth alone.
inline constexpr const char* kDepthVertexShader = R"(
layout(location = 0) in vec3 p;
uniform mat4 clip_from_W;
uniform mat4 W_from_A;
void main() { gl_Position = clip_from_W * W_from_A * vec4(p, 1.0); }
)";

inline constexpr const char* kDepthFragmentShader = R"(
void main() {}
)";

}  // namespace polnav::sim
