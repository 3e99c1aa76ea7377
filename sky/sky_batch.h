// What light comes from many directions of a cloudless sky?
//
// ClearSky::Look for arrays of rays, four at a time: for maps, images and whatever looks at a
// million rays. Same formulas, in double; the brightness of rayleigh and berry uses an exponential
// and an arc cosine of its own. Agrees with ClearSky::Look within 1e-12 in Q / I and U / I (1e-9
// within a microradian of the zenith) and 1e-6 of the radiance. The same bytes on every processor.
#pragma once

#include <span>

#include "sky/clear_sky.h"

namespace polnav::sky {

// Components of unit vectors in ENU, above the horizon; all of one length.
struct RayArrays {
  std::span<const double> east, north, up;
};

// Q / I and U / I about RayAxes; radiance relative to the zenith.
struct StokesArrays {
  std::span<double> radiance, q, u;
};

// Throws std::logic_error when the lengths differ.
void LookAlong(const ClearSky& sky, const RayArrays& rays_W, const StokesArrays& stokes);

}  // namespace polnav::sky
