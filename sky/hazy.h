// What light does a hazy sky over the sea send along one ray?
//
// Radiance and polarization for any sun elevation, wavelength and aerosol optical thickness, from a
// small vector radiative transfer (haze_field.h) with the haze's own scattering (haze_optics.h);
// four constants of air and sea are fitted to the code OSOAA, and docs/hazy_sky.md has the
// residuals. Prepared for one sun: the functions of the ray's elevation become polynomials of
// degree 7 in z, where z grows from -1 to 1 with mu / (mu + bend), mu the sine of the elevation.
// With c = sun . ray and components across the ray as complex numbers,
//   I       i0 + i1 c + ... + i4 c^4 + once p11(c)
//   Q + iU  (a0 + a1 c + a2 c^2 + once p12(c) / sin^2) s^2 + (b0 + b1 c) s z + (c0 + c1 c) z^2
// s: sun, z: zenith; once: sunlight scattered once by haze.
// Neutral points come out by themselves: Babinet, Brewster and Arago where multiple scattering and
// the sea's mirror light cancel single scattering.
// Where it fails: as haze_field.h; land, where the sky is brighter below and less horizontally
// polarized; sun below a degree, where the sky is that of a degree.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "sky/polynomial.h"
#include "sky/sky_stokes.h"

namespace polnav::sky {

// Everything that depends on the sun and the air but not on the ray.
struct HazyCoefficients {
  static constexpr int kDegree = 7;
  enum Function { kI0, kI1, kI2, kI3, kI4, kA0, kA1, kA2, kB0, kB1, kC0, kC1, kOnce, kFunctions };
  std::array<std::array<double, kDegree + 1>, kFunctions> of_z{};  // powers, highest first
  double bend = 0.1;
  double stretch = 2.0;            // z = stretch mu / (mu + bend) - 1
  std::array<double, 19> phase{};  // HazeOptics
  std::array<double, 21> polarized{};
  double zenith = 1.0;  // radiance there, over the sun's irradiance [1/sr]
  // The sun as answered, never below a degree: of_sun times the sun and of_up times the zenith.
  double of_sun = 1.0;
  double of_up = 0.0;
};

[[nodiscard]] HazyCoefficients HazyCoefficientsOf(double aot, double wavelength_nm,
                                                  double sun_elevation_rad);

// What the formulas above give for T: double, ceres::Jet, or a lane of a batch (sky_batch.cpp).
// Not normalized: [I, Q, U] over the sun's irradiance. sun, up: components along axis 1, axis 2
// and the ray.
template <typename T>
struct HazyTerms {
  T cos_sun;       // of the angle from the sun
  T sine;          // of the ray's elevation, zero or more
  T ss_re, ss_im;  // squares and product of the components across the ray, as complex numbers
  T su_re, su_im;
  T uu_re, uu_im;
};

template <typename T>
[[gnu::always_inline]] inline void HazyStokes(const HazyCoefficients& k, const HazyTerms<T>& t,
                                              T& intensity, T& q, T& u) {
  using std::sqrt;
  using F = HazyCoefficients;
  constexpr double kTiny = 1e-9;  // keeps roots from rounding errors and derivatives finite
  const T z = k.stretch * t.sine / (t.sine + k.bend) - 1.0;
  const T angle = sqrt((0.5 + kTiny) - 0.5 * t.cos_sun) - sqrt((0.5 + kTiny) + 0.5 * t.cos_sun);
  const T once = Polynomial(k.of_z[F::kOnce], z);
  const T& x = t.cos_sun;
  T sum = Polynomial(k.of_z[F::kI4], z);
  sum = sum * x + Polynomial(k.of_z[F::kI3], z);
  sum = sum * x + Polynomial(k.of_z[F::kI2], z);
  sum = sum * x + Polynomial(k.of_z[F::kI1], z);
  sum = sum * x + Polynomial(k.of_z[F::kI0], z);
  intensity = sum + once * Polynomial(k.phase, angle);
  const T a = (Polynomial(k.of_z[F::kA2], z) * x + Polynomial(k.of_z[F::kA1], z)) * x +
              Polynomial(k.of_z[F::kA0], z) + once * Polynomial(k.polarized, angle);
  const T b = Polynomial(k.of_z[F::kB1], z) * x + Polynomial(k.of_z[F::kB0], z);
  const T c = Polynomial(k.of_z[F::kC1], z) * x + Polynomial(k.of_z[F::kC0], z);
  q = a * t.ss_re + b * t.su_re + c * t.uu_re;
  u = a * t.ss_im + b * t.su_im + c * t.uu_im;
}

class HazySky {
 public:
  HazySky(double aot, double wavelength_nm, double sun_elevation_rad)
      : coefficients_(HazyCoefficientsOf(aot, wavelength_nm, sun_elevation_rad)) {}

  template <typename T>
  [[nodiscard]] SkyStokes<T> Look(const Eigen::Matrix<T, 3, 1>& true_sun,
                                  const Eigen::Matrix<T, 3, 1>& up) const {
    const Eigen::Matrix<T, 3, 1> sun =
        T(coefficients_.of_sun) * true_sun + T(coefficients_.of_up) * up;
    const HazyTerms<T> terms{.cos_sun = sun.z(),
                             .sine = up.z() > 0.0 ? up.z() : T(0.0),
                             .ss_re = sun.x() * sun.x() - sun.y() * sun.y(),
                             .ss_im = 2.0 * sun.x() * sun.y(),
                             .su_re = sun.x() * up.x() - sun.y() * up.y(),
                             .su_im = sun.x() * up.y() + sun.y() * up.x(),
                             .uu_re = up.x() * up.x() - up.y() * up.y(),
                             .uu_im = 2.0 * up.x() * up.y()};
    T intensity, q, u;
    HazyStokes(coefficients_, terms, intensity, q, u);
    return {intensity / coefficients_.zenith, q / intensity, u / intensity};
  }

  [[nodiscard]] const HazyCoefficients& coefficients() const { return coefficients_; }

 private:
  HazyCoefficients coefficients_;
};

}  // namespace polnav::sky
