// What polarization does a clear sky with neutral points show along one ray?
//
// [Berry2004] without its stereographic coordinates. The complex w, whose phase is twice the angle
// of polarization, is the product of the ray's distances from two points: Babinet a half separation
// above the sun and Brewster as far below it, and by symmetry their antipodes, Arago above the
// antisun and the fourth below. |w| becomes Rayleigh's sin^2 when the points meet in the sun, and
// max_dop |w| / (2 - |w|) Rayleigh's degree of polarization.
//   sun, up   unit vectors towards sun and zenith, by their components along two axes across the
//             ray and the ray itself; the axes may have either handedness
//   returns   (Q/I, U/I) about the first axis, angles counted towards the second [-]
// Multiplied out, w = sun^2 a + sun up b + up^2 c with the transverse parts as complex numbers: a
// polynomial, so smooth at the zenith, at the sun, and right for ceres::Jet as it stands.
// Where it fails: both points at the same distance, though Brewster's is larger over a bright
// ground; the same dilution everywhere, though haze takes most near the horizon (hazy.h).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "sky/cie_sky.h"
#include "sky/sky_stokes.h"

namespace polnav::sky {

class BerrySky {
 public:
  // max_dop: degree of polarization 90 degrees from the sun, were the points to meet.
  BerrySky(double max_dop, double half_separation_rad, double sun_elevation_rad)
      : max_dop_(max_dop), half_separation_rad_(half_separation_rad) {
    // The points are cos(half) sun +- sin(half) tangent, where the tangent at the sun towards the
    // zenith is (up - sin sun) / cos. At the zenith there is none, and the points meet.
    const double sine = std::sin(sun_elevation_rad);
    const double cosine = std::max(std::cos(sun_elevation_rad), 1e-4);
    const double split = std::sin(half_separation_rad) / cosine;
    sun2_ = -1.0 + std::pow(std::sin(half_separation_rad), 2) + split * split * sine * sine;
    sun_up_ = -2.0 * split * split * sine;
    up2_ = split * split;
  }

  template <typename T>
  [[nodiscard]] Eigen::Matrix<T, 2, 1> Polarization(const Eigen::Matrix<T, 3, 1>& sun,
                                                    const Eigen::Matrix<T, 3, 1>& up) const {
    using std::sqrt;
    const T re = sun2_ * (sun.x() * sun.x() - sun.y() * sun.y()) +
                 sun_up_ * (sun.x() * up.x() - sun.y() * up.y()) +
                 up2_ * (up.x() * up.x() - up.y() * up.y());
    const T im = 2.0 * sun2_ * sun.x() * sun.y() + sun_up_ * (sun.x() * up.y() + sun.y() * up.x()) +
                 2.0 * up2_ * up.x() * up.y();
    // 1e-300 keeps the derivative of the modulus finite at the neutral points.
    const T scale = max_dop_ / (2.0 - sqrt(re * re + im * im + 1e-300));
    return Eigen::Matrix<T, 2, 1>(re * scale, im * scale);
  }

  template <typename T>
  [[nodiscard]] SkyStokes<T> Look(const Eigen::Matrix<T, 3, 1>& sun,
                                  const Eigen::Matrix<T, 3, 1>& up) const {
    const Eigen::Matrix<T, 2, 1> p = Polarization<T>(sun, up);
    return {CieRadiance<T>(sun, up), p.x(), p.y()};
  }

  [[nodiscard]] double max_dop() const { return max_dop_; }
  [[nodiscard]] double half_separation_rad() const { return half_separation_rad_; }
  // Of sun^2, sun up and up^2.
  [[nodiscard]] Eigen::Vector3d coefficients() const { return {sun2_, sun_up_, up2_}; }

 private:
  double max_dop_;
  double half_separation_rad_;
  double sun2_;
  double sun_up_;
  double up2_;
};

// Half of what lies between Babinet and Brewster [rad]: see berry.cpp for where it comes from.
[[nodiscard]] double BerryHalfSeparation(double sun_elevation_rad, double aot);

}  // namespace polnav::sky
