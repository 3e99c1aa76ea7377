// What light does hazy air over a sea hold at each height, and what of it does a ray collect?
//
// Plane air of molecules (scale height 8 km) and haze (2 km), lit by the sun and by the sea's glint
// (sea.h). Vector radiative transfer [Chandrasekhar1960] by successive orders of scattering in
// Fourier modes of the azimuth from the sun, haze by generalized spherical functions to order
// kHazeOrders (haze_optics.h). Sunlight that haze scatters once is kept apart, for the phase
// function proper. From this hazy.h puts the sky together.
// Where it fails: sun below a degree (answered as at one degree), haze of optical thickness much
// beyond 0.5, other profiles, dust or soot, land in place of the sea.
#pragma once

#include <array>

#include "sky/haze_scattering.h"

namespace polnav::sky {

inline constexpr int kHazeModes = 5;

// What a ray from the ground at this elevation collects, over the sun's irradiance [1/sr].
struct HazeRay {
  // Modes of the azimuth from the sun: I and Q with cos(m azimuth), U with the sine.
  std::array<double, kHazeModes> i{}, q{}, u{};
  double sun;  // scattered once by haze, over its phase function
};

class HazeField {
 public:
  HazeField(const HazeAir& air, double sun_elevation_rad);

  // sine: of the ray's elevation, above zero.
  [[nodiscard]] HazeRay Along(double sine) const;

  [[nodiscard]] double sun_elevation_rad() const { return sun_elevation_rad_; }

 private:
  double sun_elevation_rad_;  // as answered
  HazeProfile depth_;         // above each level
  HazeProfile sun_;           // source of light that haze scatters once
  std::array<HazeLight, kHazeModes> sent_;
};

}  // namespace polnav::sky
