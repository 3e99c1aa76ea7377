// What light does hazy air over a sea hold at each height, and what of it does a ray collect?
//
// Functions of the ray's elevation alone from which hazy.h puts the sky together. Plane air of
// molecules (scale height 8 km) and haze (2 km), lit by the sun and by the sea's glint (sea.h).
// Molecules scatter the tensor of the electric field as Rayleigh has it, to all orders: for them
// this is the vector radiative transfer [Chandrasekhar1960], not an approximation. Of haze the
// forward peak is taken out and counted as unscattered [Wiscombe1977]; the rest scatters intensity
// by the first two Legendre moments of its phase function and polarization by one. Light that haze
// scatters once, from the sun or the glint, is kept apart for the phase function proper.
// Successive orders of scattering, in Fourier modes of the azimuth from the sun.
// Where it fails: sun below a degree (answered as at one degree), haze of optical thickness much
// beyond 0.5, other profiles, dust or soot, land in place of the sea.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sky/haze_scattering.h"
#include "sky/sea.h"

namespace polnav::sky {

// What a ray from the ground at this elevation collects, over the sun's irradiance [1/sr].
struct HazeRay {
  // Intensity: i0 + i1 x + i2 (2 x^2 - cos^2(sun) cos^2(ray)), x = cos(sun) cos(ray) cos(azimuth).
  double i0, i1, i2;
  // Q + i U of the tensor a s s + b (s z + z s) + c z z, s towards the sun, z up.
  double a, b, c;
  // Scattered once by haze, over its phase function: sunlight and glint.
  double sun, glint;
};

class HazeField {
 public:
  HazeField(const HazeAir& air, double sun_elevation_rad);

  // sine: of the ray's elevation, above zero.
  [[nodiscard]] HazeRay Along(double sine) const;

  // Unit vector to where the glint comes from (x below the sun, y across, z up), and its degree of
  // polarization across the sun's vertical plane.
  [[nodiscard]] const Eigen::Vector3d& glint_from() const { return glint_from_; }
  [[nodiscard]] double glint_dop() const { return glint_dop_; }

 private:
  void KeepOnce(const LitAir& air, const std::vector<GlintRay>& glint);

  double sine_;  // of the sun's elevation
  double cosine2_;
  HazeProfile depth_;  // above each level
  Eigen::Vector3d glint_from_;
  double glint_dop_;
  // Sources by the function of the ray's sine mu that they go with. Intensity: mode 0 with
  // 1 + mu^2, 1 - mu^2, 1, mu and P2(mu); mode 1 with mu, 1; mode 2.
  Eigen::Array<double, kHazeLevels, 5> i0_;
  Eigen::Array<double, kHazeLevels, 2> i1_;
  Eigen::Array<double, kHazeLevels, 1> i2_;
  // Tensor: zz less the horizontal, xz, (xx - yy) / 2, over their powers of the sun's cosine.
  Eigen::Array<double, kHazeLevels, 3> tensor_;
  Eigen::Array<double, kHazeLevels, 2> once_;  // sun, glint
};

}  // namespace polnav::sky
