#include "sky/berry.h"

namespace polnav::sky {

// Light scattered more than once is polarized vertically, by the cosine of elevation squared, and
// cancels the sin^2 of single scattering at sin(half) = k cos(elevation). The share k of multiple
// scattering grows with the sun's slant path and with haze. Shape and numbers are fitted to OSOAA's
// principal plane at 450 nm.
double BerryHalfSeparation(double sun_elevation_rad, double aot) {
  const double slant = 1.0 / (std::max(std::sin(sun_elevation_rad), 0.0) + 0.15);
  const double share = 0.09 * slant * (1.0 + 0.5 * aot);
  return std::asin(std::min(share, 0.5) * std::max(std::cos(sun_elevation_rad), 0.0));
}

}  // namespace polnav::sky
