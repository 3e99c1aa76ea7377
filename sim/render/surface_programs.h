// Which shader draws a surface, and with what light?
#pragma once

#include <Eigen/Core>
#include <array>

#include "sim/render/gl_context.h"
#include "sim/render/grain.h"

namespace polnav::sim {

// What a surface needs; see shaders.h.
struct SurfaceNeeds {
  bool actor = false;
  bool sun_shadow = false;
  bool actor_shadow = false;
  bool fog = false;
  bool close_up = false;
};

// The same for all surfaces of a picture. Radiance 1 is the clear zenith's.
struct PictureLight {
  Eigen::Matrix4f clip_from_W;  // in a close-up of what is relative to the eye
  Eigen::Matrix4f sun_map_from_W;
  Eigen::Matrix4f actor_map_from_W;
  Eigen::Vector3f eye_W;
  float exposure = 0.0F;
  float sun_share = 1.0F;       // of sunlight that the clouds let through
  float extinction_1_m = 0.0F;  // 0: no fog
  float airlight = 0.0F;        // radiance of fog without end
  GrainAtEye grain;             // of a close-up
};

// What turning things are lit by; see Lighting.
struct StandingLight {
  Eigen::Vector3f sun_W;
  float sun = 0.0F;
  std::array<float, 9> harmonics{};
};

inline constexpr GLenum kSunMapUnit = GL_TEXTURE1;
inline constexpr GLenum kActorMapUnit = GL_TEXTURE2;
inline constexpr GLenum kGrainUnit = GL_TEXTURE3;

class SurfacePrograms {
 public:
  SurfacePrograms(const GlContext& context, const StandingLight& light);

  // Everything drawn after this is drawn so, until the next.
  void Use(const SurfaceNeeds& needs, const PictureLight& light);
  // Of the actor drawn next; after Use with needs.actor.
  void Place(const Eigen::Matrix4f& W_from_A) const;

 private:
  struct Program {
    GLuint id = 0;
    GLint W_from_A = -1;
  };
  void SetGrain(GLuint program, const GrainAtEye& grain) const;
  [[nodiscard]] Program Link(const SurfaceNeeds& needs) const;

  const GlContext& context_;
  StandingLight light_;
  std::array<Program, 32> programs_{};  // linked when first used
  GLint W_from_A_ = -1;
};

}  // namespace polnav::sim
