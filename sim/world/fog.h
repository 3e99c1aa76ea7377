// How much does a fog hide, and how bright is it inside?
//
// A bank 50 m thick about and above the vehicle, of one density. Droplets scatter mostly forward
// and absorb nothing.
#pragma once

namespace polnav::sim {

inline constexpr double kFogThickness_m = 50.0;

// Contrast falls to 2 % at the visibility: -ln 0.02 over it [Koschmieder1924]. Zero without fog,
// that is for an infinite visibility [1/m].
[[nodiscard]] inline double FogExtinction(double visibility_m) { return 3.912 / visibility_m; }

// Optical depth from the ground straight up.
[[nodiscard]] inline double FogDepth(double visibility_m) {
  return FogExtinction(visibility_m) * kFogThickness_m;
}

// Radiance inside, alike from all sides and unpolarized: what falls on it from above, as radiance
// of a white level facet, less what it throws back (two streams [Bohren1987]).
[[nodiscard]] inline double FogRadiance(double fallen, double visibility_m) {
  constexpr double kAsymmetry = 0.85;
  return fallen / (1.0 + 0.75 * (1.0 - kAsymmetry) * FogDepth(visibility_m));
}

}  // namespace polnav::sim
