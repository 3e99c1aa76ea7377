// What polarization does Rayleigh's sky have in every block of a picture, for the sun at one angle?
//
// The sun stands at s_L(a) = (cos h cos a, cos h sin a, sin h), elevation h, in the level frame L
// of sky_blocks.h. Along Rayleigh's direction and across it are meant in the (Q/I, U/I) plane,
// about each block's own axes. What is seen across is zero under a single-scattering sky; its
// derivative by the angle is exact, and tested against finite differences.
#pragma once

#include <Eigen/Core>

#include "nav/polarization/sky_blocks.h"

namespace polnav::nav {

class RayleighPattern {
 public:
  RayleighPattern(const SkyBlocks& sky, double sun_elevation_rad);

  struct Values {
    Eigen::ArrayXf along;     // of (q, u) along Rayleigh's direction
    Eigen::ArrayXf across;    // and across it: the residual
    Eigen::ArrayXf fraction;  // of the greatest polarization that Rayleigh has there
    Eigen::ArrayXf turn;      // d(direction in the (q, u) plane) / d(angle)
    Eigen::ArrayXf mx;        // the direction
    Eigen::ArrayXf my;
  };
  // -turn * along is the derivative of across.
  void At(double angle_rad, Values& values) const;

  // What a unit of vertically polarized light, by the square of the elevation's cosine, adds to the
  // residual.
  [[nodiscard]] Eigen::ArrayXf VerticalAcross(const Values& values) const;

  // d(direction) / d(rotation vector of the sun, in L), at an angle: a row a block.
  [[nodiscard]] Array3Xf TurnBySun(double angle_rad) const;

 private:
  const SkyBlocks* sky_;
  float sine_;
  float cosine_;
};

}  // namespace polnav::nav
