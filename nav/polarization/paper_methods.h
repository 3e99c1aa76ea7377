// At which angle does the sun stand, as the papers have it?
//
// The E-vector e at a ray is across the sun, e . s = 0 [Fan2020, eqs 1-7], and s(a) is linear in
// x = (cos a, sin a): one row h x = b a block [Fan2020, eqs 8-14]. a is the sun's angle from the
// level x axis towards y, which is Fan2020's psi + alpha_s up to the paper's senses of rotation.
//   lsq         ordinary least squares over all blocks alike: what Fan2020 compares with
//   ransac_tls  single blocks propose, blocks within a threshold of angle agree, total least
//   squares
//               of those refines [Fan2020, eqs 15-18]: the right singular vector of the smallest
//               singular value of [-b h], divided by its first component, then x normalized
//   zenith      E-vector of the patch about the vertical, [Chu2021, eq. 8]
// Mended: the paper's rows (d of eq. 8 holds tan(phi)) are e . s = 0 times sin(gamma) over
// cos(phi), so that an E-vector across the image's radius outweighs all others however wrong it is.
// Here e has unit length in both methods, which does the paper good: with its own rows a sky of few
// clouds gave 1.5 instead of 0.2 degrees. Without the sun's elevation the same rows are solved for
// s itself, up to its sign. Random draws are a hash of the sample's number: the same picture gives
// the same heading. sigma: scatter of the angles about the solution, with one independent value a
// tile. The papers give none.
#pragma once

#include <optional>
#include <vector>

#include "nav/polarization/compass_options.h"
#include "nav/polarization/sky_blocks.h"

namespace polnav::nav {

struct PaperFit {
  double angle_rad = 0.0;  // of the sun's azimuth, in L
  double sigma_rad = 0.0;
  std::vector<bool> used;  // a block of `sky`
};

// sun_elevation_rad: absent, then the angle is good mod pi.
// Nothing when too few blocks are left to solve for it.
[[nodiscard]] std::optional<PaperFit> FitLeastSquares(const SkyBlocks& sky,
                                                      std::optional<double> sun_elevation_rad);
[[nodiscard]] std::optional<PaperFit> FitRansacTls(const CompassOptions& options,
                                                   const SkyBlocks& sky,
                                                   std::optional<double> sun_elevation_rad);
// Good mod pi.
[[nodiscard]] std::optional<PaperFit> ReadZenith(const CompassOptions& options,
                                                 const SkyBlocks& sky,
                                                 std::optional<double> sun_elevation_rad);

}  // namespace polnav::nav
