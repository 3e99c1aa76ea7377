// How is one Fourier mode of light scattered in hazy air over the sea?
//
// What haze_field.h is made of. Light is known by moments at each level: tensor, the second moment
// of the electric field (x below the sun, y across, z up), as Rayleigh's scattering needs it, and
// Legendre moments of the intensity, as haze needs them. I and Q go with cos(m azimuth from the
// sun), U with the sine; Q and U are about the axes of ray_axes.h. Nothing above m = 2 is
// scattered.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sky/sea.h"

namespace polnav::sky {

// Optical thicknesses of a vertical column.
struct HazeAir {
  double molecules;
  double haze;          // the forward peak included
  double water_albedo;  // of light that comes back out of the water
};
// aot: aerosol optical thickness at 550 nm.
[[nodiscard]] HazeAir HazeAirOf(double aot, double wavelength_nm);

inline constexpr int kHazeLevels = 17;  // from the top of the air to the ground
using HazeProfile = Eigen::Array<double, kHazeLevels, 1>;

// The air at each level, and the sun's light there.
struct LitAir {
  double sine, cosine;  // of the sun's elevation
  double water_albedo;
  HazeProfile depth;      // above each level
  HazeProfile molecules;  // share of what scatters there
  HazeProfile haze;       // share, times what absorption and the forward peak leave of it
  HazeProfile sun;        // direct light
};
[[nodiscard]] LitAir Light(const HazeAir& air, double sun_elevation_rad);

// What is left of a ray of glint at each level, on its way up.
[[nodiscard]] HazeProfile GlintAt(const GlintRay& ray, const LitAir& air);

// Moments of one mode; absent ones are zero. Tensor: mode 0 (xx + yy) / 2 and zz; mode 1 xz; mode 2
// (xx - yy) / 2.
struct HazeMoments {
  std::array<HazeProfile, 2> tensor = {HazeProfile::Zero(), HazeProfile::Zero()};
  std::array<HazeProfile, 2> polarized = tensor;  // tensor of the polarization alone
  std::array<HazeProfile, 3> light = {HazeProfile::Zero(), HazeProfile::Zero(),
                                      HazeProfile::Zero()};  // by the Legendre polynomial's order

  HazeMoments& operator+=(const HazeMoments& other);
};

struct ScatteredMode {
  HazeMoments first;   // the sun and its glint
  HazeMoments orders;  // what was scattered at least once
};
[[nodiscard]] ScatteredMode Scatter(int m, const LitAir& air, const std::vector<GlintRay>& glint);

// How strongly light is scattered again, for a moment of 1 and a share of 1.
// By air, the tensor's part; the rest of air's scattering is even and unpolarized.
[[nodiscard]] double TensorByAir();
[[nodiscard]] double EvenByAir();
// By haze: the tensor of the polarization, and the intensity's moment of order l in mode m.
[[nodiscard]] double TensorByHaze();
[[nodiscard]] double LightByHaze(int m, int l);

}  // namespace polnav::sky
