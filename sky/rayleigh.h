// What polarization does a single-scattering sky show along one ray?
//
// The sky that an estimator assumes; the simulated one is skylight.h. One scattering, point-like
// sun, no haze but for max_dop: no neutral points, wrong by several degrees near sun and antisun
// and under cloud.
//   P         frame of the ray: z along the viewing ray (towards the sky), x and y transverse
//   s_P       unit vector towards the sun, in P
//   max_dop   degree of polarization 90 degrees from the sun [-]; 1 for a pure Rayleigh sky
//   returns   (Q/I, U/I) about P's x axis, angles counted from x towards y [-]
// The E-vector is perpendicular to the plane of sun, observer and ray [Chu2021, eqs 5-7]:
// E ~ z x s, and the degree of polarization is max_dop sin^2 / (1 + cos^2) of the angle from the
// sun. The sine cancels the angle's singularity, so the result is rational in s_P: smooth at the
// sun, and right for ceres::Jet as it stands.
#pragma once

#include <Eigen/Core>

namespace polnav::sky {

// U is T, or double for a constant.
template <typename T, typename U = double>
[[nodiscard]] Eigen::Matrix<T, 2, 1> RayleighStokes(const Eigen::Matrix<T, 3, 1>& s_P,
                                                    const U& max_dop) {
  // s_P has unit length, so 1 + cos^2 = x^2 + y^2 + 2 z^2. This form is as smooth, and keeps its
  // meaning under the rounding of a quaternion that is not quite normalized.
  const T x2 = s_P.x() * s_P.x();
  const T y2 = s_P.y() * s_P.y();
  const T scale = max_dop / (x2 + y2 + s_P.z() * s_P.z() * 2.0);
  return Eigen::Matrix<T, 2, 1>((y2 - x2) * scale, s_P.x() * s_P.y() * (-2.0) * scale);
}

}  // namespace polnav::sky
