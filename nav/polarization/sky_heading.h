// Which headings fit a measured E-vector?
//
// Under a Rayleigh sky the E-vector is perpendicular to the sun [Chu2021, eqs 5-8]: s_W . e_W = 0.
// With pitch and roll known, only the turn about the vertical is left, and the equation has two
// solutions: for a level sensor they are half a turn apart and equal Chu2021's
//   psi = alpha + f_s +- pi/2   (alpha: E-vector's compass-wise angle from the body's x axis).
// The real sky is not Rayleigh's; near the horizon and through cloud the difference is degrees.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "nav/api/geometry.h"

namespace polnav::nav {

// e_B: unit E-vector in B (its sign means nothing); q_WB: attitude whose pitch and roll are used
// and whose heading chooses between the two solutions; sun_W: unit vector towards the sun.
// Returns the compass heading [rad] nearest to q_WB's, or nothing when no heading fits.
[[nodiscard]] std::optional<double> HeadingFromEVector(const Eigen::Vector3d& e_B,
                                                       const Eigen::Quaterniond& q_WB,
                                                       const Eigen::Vector3d& sun_W);

// How the heading answered above changes with a tilt (dtheta_E, dtheta_N) of the attitude in W [-].
// Grows with the sun's height.
[[nodiscard]] Eigen::Vector2d HeadingByTilt(const Eigen::Vector3d& e_W,
                                            const Eigen::Vector3d& sun_W);

// Degree of polarization under a Rayleigh sky of this maximum, in direction look_W.
[[nodiscard]] double RayleighDop(const Eigen::Vector3d& look_W, const Eigen::Vector3d& sun_W,
                                 double max_dop);

}  // namespace polnav::nav
