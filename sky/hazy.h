// What light does a hazy sky over the sea send along one ray?
//
// Radiance and polarization for any sun elevation, wavelength and aerosol optical thickness, from a
// small radiative transfer (haze_field.h) whose 17 constants are fitted to the code OSOAA; docs/
// hazy_sky.md has the residuals. Prepared for one sun: the functions of the ray's elevation become
// polynomials of degree 10 in z, where z grows from -1 to 1 with mu / (mu + bend), mu the sine of
// the elevation. With c = sun . ray and components across the ray as complex numbers,
//   I       i0 + i1 c + i2 c^2 + sun P(c) + glint P(c of glint)
//   Q + iU  a s^2 + b s z + c z^2 - sun F(c) s^2 + glint p y^2
// s: sun, z: zenith, y: horizontal across the sun; P, F: haze_constants.h.
// Neutral points come out by themselves: Babinet, Brewster and Arago where multiple scattering and
// the sea's mirror light cancel single scattering.
// Where it fails: as haze_field.h; land, where the sky is brighter below and less horizontally
// polarized; sun below a degree, where its pattern moves on but its strengths stay.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "sky/haze_constants.h"
#include "sky/polynomial.h"
#include "sky/sky_stokes.h"

namespace polnav::sky {

// Everything that depends on the sun and the air but not on the ray.
struct HazyCoefficients {
  static constexpr int kDegree = 10;
  enum Function { kI0, kI1, kI2, kA, kB, kC, kSun, kGlint, kFunctions };
  std::array<std::array<double, kDegree + 1>, kFunctions> of_z{};  // powers, highest first
  double bend = 0.1;
  double stretch = 2.0;       // z = stretch mu / (mu + bend) - 1
  double glint_by_sun = 0.0;  // cosine from the glint = these, times that from sun and zenith
  double glint_by_up = 0.0;
  double glint_dop = 0.0;          // over the squared cosine of the sun's elevation
  std::array<double, 3> across{};  // F over sin^2: even, with the cosine, with the peak
  double zenith = 1.0;             // radiance there, over the sun's irradiance [1/sr]
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
  T yy_re, yy_im;  // of zenith x sun
};

// Haze's phase function and its peak, of the cosine of the scattering angle.
template <typename T>
[[gnu::always_inline]] inline T HazePeak(const T& cosine) {
  const T root = haze::kPeak / (haze::kPeakAt - cosine);
  return root * root;
}
template <typename T>
[[gnu::always_inline]] inline T HazePhase(const T& cosine) {
  return HazePeak<T>(cosine) + haze::kEven0 + (haze::kEven1 + haze::kEven2 * cosine) * cosine;
}

template <typename T>
[[gnu::always_inline]] inline void HazyStokes(const HazyCoefficients& k, const HazyTerms<T>& t,
                                              T& intensity, T& q, T& u) {
  const T z = k.stretch * t.sine / (t.sine + k.bend) - 1.0;
  using F = HazyCoefficients;
  const T sun = Polynomial(k.of_z[F::kSun], z);
  const T b = Polynomial(k.of_z[F::kB], z);
  const T c = Polynomial(k.of_z[F::kC], z);
  const T from_glint = Polynomial(k.of_z[F::kGlint], z) *
                       HazePhase<T>(k.glint_by_sun * t.cos_sun + k.glint_by_up * t.sine);
  intensity =
      Polynomial(k.of_z[F::kI0], z) +
      (Polynomial(k.of_z[F::kI1], z) + Polynomial(k.of_z[F::kI2], z) * t.cos_sun) * t.cos_sun +
      sun * HazePhase<T>(t.cos_sun) + from_glint;
  const T across = k.across[0] + k.across[1] * t.cos_sun + k.across[2] * HazePeak<T>(t.cos_sun);
  const T a = Polynomial(k.of_z[F::kA], z) - sun * across;
  const T y = k.glint_dop * from_glint;
  q = a * t.ss_re + b * t.su_re + c * t.uu_re + y * t.yy_re;
  u = a * t.ss_im + b * t.su_im + c * t.uu_im + y * t.yy_im;
}

class HazySky {
 public:
  HazySky(double aot, double wavelength_nm, double sun_elevation_rad)
      : coefficients_(HazyCoefficientsOf(aot, wavelength_nm, sun_elevation_rad)) {}

  template <typename T>
  [[nodiscard]] SkyStokes<T> Look(const Eigen::Matrix<T, 3, 1>& sun,
                                  const Eigen::Matrix<T, 3, 1>& up) const {
    const T y1 = up.y() * sun.z() - up.z() * sun.y();
    const T y2 = up.z() * sun.x() - up.x() * sun.z();
    const HazyTerms<T> terms{.cos_sun = sun.z(),
                             .sine = up.z() > 0.0 ? up.z() : T(0.0),
                             .ss_re = sun.x() * sun.x() - sun.y() * sun.y(),
                             .ss_im = 2.0 * sun.x() * sun.y(),
                             .su_re = sun.x() * up.x() - sun.y() * up.y(),
                             .su_im = sun.x() * up.y() + sun.y() * up.x(),
                             .uu_re = up.x() * up.x() - up.y() * up.y(),
                             .uu_im = 2.0 * up.x() * up.y(),
                             .yy_re = y1 * y1 - y2 * y2,
                             .yy_im = 2.0 * y1 * y2};
    T intensity, q, u;
    HazyStokes(coefficients_, terms, intensity, q, u);
    return {intensity / coefficients_.zenith, q / intensity, u / intensity};
  }

  [[nodiscard]] const HazyCoefficients& coefficients() const { return coefficients_; }

 private:
  HazyCoefficients coefficients_;
};

}  // namespace polnav::sky
