// Which functions of the elevation does scattering turn into each other?
//
// Generalized spherical functions [Siewert1982] of one Fourier mode m of the azimuth, at given
// sines of elevation. A field's moments of order l are sums of A I over its directions, and what
// scattering makes of them shows as A^T, with the symmetric
//   A = [p 0 0; 0 r t; 0 t r]
// for I, Q (with cos m azimuth) and U (with the sine), axes as in ray_axes.h. Rows: l from m up.
#pragma once

#include <Eigen/Core>

namespace polnav::sky {

// I, Q and U: of some orders or directions (rows) at some levels (columns).
struct HazeLight {
  Eigen::MatrixXd i, q, u;
  HazeLight& operator+=(const HazeLight& other);
};

struct HazeBasis {
  HazeBasis(int m, const Eigen::ArrayXd& sines);

  [[nodiscard]] HazeLight Shown(const HazeLight& moments) const;
  [[nodiscard]] HazeLight Moments(const HazeLight& light) const;

  Eigen::MatrixXd p, r, t;
};

}  // namespace polnav::sky
