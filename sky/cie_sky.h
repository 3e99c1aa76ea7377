// How bright is a clear sky, seen along one ray?
//
// CIE standard general sky, type 12 (clear, low turbidity) [CIE2003]: a gradation with the zenith
// angle times an indicatrix of the angle from the sun, relative to the zenith. Broad band: no
// wavelength, no aerosol but what "low turbidity" means.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace polnav::sky {

namespace cie12 {

inline constexpr double kGradient = -0.32;
inline constexpr double kAureole = 10.0;
inline constexpr double kAureoleDecay = -3.0;
inline constexpr double kBackscatter = 0.45;
inline constexpr double kHorizonCosine = 1e-6;  // the gradation is flat there
inline const double kAureoleAcross = std::exp(0.5 * kAureoleDecay * std::numbers::pi);

template <typename T>
[[nodiscard]] T Gradation(const T& cos_zenith) {
  using std::exp;
  return 1.0 - exp(kGradient / (cos_zenith > kHorizonCosine ? cos_zenith : T(kHorizonCosine)));
}

template <typename T>
[[nodiscard]] T Indicatrix(const T& angle_rad) {
  using std::cos;
  using std::exp;
  const T cosine = cos(angle_rad);
  return 1.0 + kAureole * (exp(kAureoleDecay * angle_rad) - kAureoleAcross) +
         kBackscatter * cosine * cosine;
}

}  // namespace cie12

// sun, up: unit vectors, by their components along axis 1, axis 2 and the ray.
template <typename T>
[[nodiscard]] T CieRadiance(const Eigen::Matrix<T, 3, 1>& sun, const Eigen::Matrix<T, 3, 1>& up) {
  using std::atan2;
  using std::sqrt;
  // 1e-300 keeps the derivative finite at the sun, where the aureole has its tip.
  const T across = sqrt(sun.x() * sun.x() + sun.y() * sun.y() + 1e-300);
  const T high = sun.dot(up);
  const T sun_from_zenith = atan2(sqrt(sun.cross(up).squaredNorm() + 1e-300), high);
  return cie12::Indicatrix<T>(atan2(across, sun.z())) * cie12::Gradation<T>(up.z()) /
         (cie12::Indicatrix<T>(sun_from_zenith) * cie12::Gradation<T>(T(1.0)));
}

}  // namespace polnav::sky
