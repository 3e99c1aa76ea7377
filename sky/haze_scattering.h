// How is one Fourier mode of light scattered in hazy air over the sea?
//
// What haze_field.h is made of: vector radiative transfer by successive orders of scattering, light
// known at each level by its moments (haze_basis.h). I and Q go with cos(m azimuth from the sun), U
// with the sine; Q and U are about the axes of ray_axes.h.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sky/haze_basis.h"
#include "sky/haze_optics.h"
#include "sky/sea.h"

namespace polnav::sky {

// Optical thicknesses of a vertical column.
struct HazeAir {
  double molecules;
  double haze;          // the forward peak included
  double water_albedo;  // of light that comes back out of the water
  HazeOptics optics;
};
// aot: aerosol optical thickness at 550 nm.
[[nodiscard]] HazeAir HazeAirOf(double aot, double wavelength_nm);

inline constexpr int kHazeLevels = 13;  // from the top of the air to the ground
using HazeProfile = Eigen::Array<double, kHazeLevels, 1>;

// The air at each level, and the sun's light there.
struct LitAir {
  double sine, cosine;  // of the sun's elevation
  double water_albedo;
  HazeOptics optics;
  HazeProfile depth;      // above each level
  HazeProfile molecules;  // share of what scatters there
  HazeProfile haze;       // share, times what absorption and the forward peak leave of it
  HazeProfile sun;        // direct light
};
[[nodiscard]] LitAir Light(const HazeAir& air, double sun_elevation_rad);

// Moments of what each level sends out, without the sunlight that haze scatters once: that is for
// the phase function proper. glint: the sun's rays from the sea.
[[nodiscard]] HazeLight Scatter(int m, const LitAir& air, const std::vector<GlintRay>& glint);

}  // namespace polnav::sky
