#include "sky/hazy.h"

#include <algorithm>
#include <numbers>

#include "sky/haze_field.h"

namespace polnav::sky {

namespace {

using std::numbers::pi;
using K = HazyCoefficients;

constexpr int kNodes = K::kDegree + 1;

// The field's functions as HazyStokes needs them: i1, i2 of cos_sun instead of the haze_field's x,
// x = cos_sun - sin(sun) mu.
std::array<double, K::kFunctions> Functions(const HazeField& field, double mu, double sun_sine) {
  const HazeRay ray = field.Along(mu);
  const double shift = sun_sine * mu;
  const double flat2 = (1.0 - sun_sine * sun_sine) * (1.0 - mu * mu);
  return {ray.i0 - ray.i1 * shift + ray.i2 * (2.0 * shift * shift - flat2),
          ray.i1 - 4.0 * ray.i2 * shift,
          2.0 * ray.i2,
          ray.a,
          2.0 * ray.b,
          ray.c,
          ray.sun,
          ray.glint};
}

// Chebyshev polynomials' powers: [n][power].
std::array<std::array<double, kNodes>, kNodes> ChebyshevPowers() {
  std::array<std::array<double, kNodes>, kNodes> t{};
  t[0][0] = 1.0;
  t[1][1] = 1.0;
  for (int n = 2; n < kNodes; ++n) {
    for (int power = 0; power < kNodes; ++power) {
      t[n][power] = (power > 0 ? 2.0 * t[n - 1][power - 1] : 0.0) - t[n - 2][power];
    }
  }
  return t;
}

// Interpolates at Chebyshev's nodes.
void Interpolate(const HazeField& field, double sun_sine, K& k) {
  static const auto kPowers = ChebyshevPowers();
  for (int node = 0; node < kNodes; ++node) {
    const double angle = pi * (node + 0.5) / kNodes;
    const double y = (1.0 + std::cos(angle)) / k.stretch;
    const double mu = std::min(1.0, k.bend * y / (1.0 - y));
    const auto values = Functions(field, mu, sun_sine);
    for (int n = 0; n < kNodes; ++n) {
      const double weight = (n == 0 ? 1.0 : 2.0) / kNodes * std::cos(n * angle);
      for (int power = 0; power <= n; ++power) {
        for (int i = 0; i < K::kFunctions; ++i) {
          k.of_z[i][kNodes - 1 - power] += weight * kPowers[n][power] * values[i];
        }
      }
    }
  }
}

}  // namespace

HazyCoefficients HazyCoefficientsOf(double aot, double wavelength_nm, double sun_elevation_rad) {
  const HazeAir air = HazeAirOf(aot, wavelength_nm);
  const HazeField field(air, sun_elevation_rad);
  const double sine = std::sin(sun_elevation_rad);
  const double cosine = std::max(1e-3, std::cos(sun_elevation_rad));

  K k;
  k.bend = 0.05 + 0.5 * (air.molecules + air.haze);
  k.stretch = 2.0 * (1.0 + k.bend);
  Interpolate(field, sine, k);
  k.glint_by_sun = field.glint_from().x() / cosine;
  k.glint_by_up = field.glint_from().z() - field.glint_from().x() * sine / cosine;
  k.glint_dop = field.glint_dop() / (cosine * cosine);
  const double at_wavelength = std::pow(wavelength_nm / 550.0, -haze::kAcrossPower);
  k.across = {at_wavelength * haze::kAcross0, at_wavelength * haze::kAcross1,
              at_wavelength * haze::kAcrossPeak};

  HazyTerms<double> up{};
  up.cos_sun = sine;
  up.sine = 1.0;
  double q = 0.0;
  double u = 0.0;
  HazyStokes(k, up, k.zenith, q, u);
  return k;
}

}  // namespace polnav::sky
