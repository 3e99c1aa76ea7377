// How does haze scatter light of one wavelength?
//
// Shettle and Fenn's maritime haze at 70 % humidity [Shettle1979], computed by Mie's theory in
// tools/sky_fit/haze_optics.py and kept in haze_table.cpp for 400 to 700 nm. Nothing is fitted to
// skies. Scattering turns I, Q, U about its plane by [p11 p12 0; p12 p11 0; 0 0 p33], p11 with mean
// 1 over the sphere. Within 20 degrees the forward peak is taken out, as OSOAA has it [Chami2015]:
// log p11 goes on as a straight line of the angle, and the rest counts as not scattered.
// Where it fails: dust, soot, humid haze; the aureole within some degrees of the sun.
#pragma once

#include <array>

namespace polnav::sky {

inline constexpr int kHazeOrders = 8;
using HazeMoments = std::array<double, kHazeOrders + 1>;

struct HazeOptics {
  double extinction;  // over that at 550 nm
  double albedo;      // what is scattered of what is taken from a ray
  double forward;     // share of what is scattered that is in the forward peak
  // Without the peak, by generalized spherical functions [Siewert1982], 2 l + 1 included: I from I,
  // Q from I (and I from Q), Q from Q, U from U.
  HazeMoments ii, iq, qq, uu;
  // p11, and p12 over the squared sine of the angle of scattering, highest power first, of
  // sin(angle / 2) - cos(angle / 2).
  std::array<double, 19> phase;
  std::array<double, 21> polarized;
};

// Between the table's wavelengths by a parabola in each number; nearest outside of them.
[[nodiscard]] HazeOptics HazeOpticsAt(double wavelength_nm);

inline constexpr int kHazeWavelengths = 7;
inline constexpr double kFirstHazeWavelength_nm = 400.0;
inline constexpr double kHazeWavelengthStep_nm = 50.0;

}  // namespace polnav::sky
