// What does the ground look like from so close that the world's textures are smooth?
//
// Those have texels of some millimetres, made for cameras on cars. A close-up multiplies them by a
// grain of random cells from 1 to 150 mm: one noise at two scales, turned against each other, so
// that it does not repeat within a picture. Looked up by W's x and y: right on the ground,
// stretched on walls. Where it lies is worked out in double precision at the eye, since a float is
// good to 4 um only 50 m from the origin.
#pragma once

#include <Eigen/Core>

#include "sim/render/gl_context.h"

namespace polnav::sim {

// contrast: one sigma of the grain over the surface's mean reflectance.
struct CloseUp {
  double contrast = 0.1;
};

// Texture coordinates at the eye, and how they grow with the distance from it.
struct GrainAtEye {
  Eigen::Vector3f eye_rest_W = Eigen::Vector3f::Zero();  // what the eye in floats lacks
  Eigen::Vector2f fine_at_eye = Eigen::Vector2f::Zero();
  Eigen::Vector2f coarse_at_eye = Eigen::Vector2f::Zero();
  float fine_per_m = 0.0F;
  Eigen::Vector2f coarse_per_m = Eigen::Vector2f::Zero();  // of u along x and y; v is square to it
  float gain = 0.0F;
};
[[nodiscard]] GrainAtEye GrainSeenFrom(const Eigen::Vector3d& eye_W_m, const CloseUp& close_up);

// The texture, mip-mapped.
[[nodiscard]] GLuint LoadGrain(const GlFunctions& gl);

}  // namespace polnav::sim
