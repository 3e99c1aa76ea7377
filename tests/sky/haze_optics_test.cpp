#include "sky/haze_optics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sky/polynomial.h"

namespace polnav::sky {
namespace {

using std::numbers::pi;

double Argument(double angle) { return std::sin(0.5 * angle) - std::cos(0.5 * angle); }

// Mean over the sphere of p11 times a Legendre polynomial, by the midpoint rule.
double Mean(const HazeOptics& optics, int l) {
  constexpr int kSteps = 4000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = pi * (i + 0.5) / kSteps;
    sum += 0.5 * std::sin(angle) * std::legendre(static_cast<unsigned>(l), std::cos(angle)) *
           Polynomial(optics.phase, Argument(angle)) * pi / kSteps;
  }
  return sum;
}

// The polynomial, which serves light scattered once, and the expansion, which serves the rest, are
// fitted apart: they agree within the polynomial's errors, half a percent of p11 forwards.
TEST(HazeOptics, HasOnePhaseFunctionInTwoForms) {
  for (const double wavelength_nm : {400.0, 450.0, 510.0, 550.0, 620.0, 700.0}) {
    const HazeOptics optics = HazeOpticsAt(wavelength_nm);
    EXPECT_NEAR(Mean(optics, 0), 1.0, 0.005) << wavelength_nm;
    for (int l = 1; l <= kHazeOrders; ++l) {
      EXPECT_NEAR((2 * l + 1) * Mean(optics, l), optics.ii[static_cast<std::size_t>(l)], 0.03)
          << wavelength_nm << " " << l;
    }
  }
}

// Sea salt is larger than the wave and scatters most of the light: extinction hardly goes with the
// wavelength (molecules: to the power of -4), and a percent or two is absorbed by the rural part.
TEST(HazeOptics, IsThatOfMaritimeHaze) {
  EXPECT_NEAR(HazeOpticsAt(550.0).extinction, 1.0, 1e-6);
  const double power = std::log(HazeOpticsAt(450.0).extinction) / std::log(550.0 / 450.0);
  EXPECT_GT(power, 0.2);
  EXPECT_LT(power, 0.6);
  for (double wavelength_nm = 400.0; wavelength_nm <= 700.0; wavelength_nm += 10.0) {
    const HazeOptics optics = HazeOpticsAt(wavelength_nm);
    EXPECT_GT(optics.albedo, 0.98);
    EXPECT_LT(optics.albedo, 0.99);
    for (double angle = 0.0; angle <= pi; angle += 0.02) {
      const double phase = Polynomial(optics.phase, Argument(angle));
      const double polarized =
          Polynomial(optics.polarized, Argument(angle)) * std::pow(std::sin(angle), 2);
      EXPECT_GT(phase, 0.0);
      EXPECT_LT(std::abs(polarized), phase);
    }
  }
}

// Spheres near the wave's size polarize across the plane of scattering at 90 degrees, as molecules
// do but weakly, and along it in the rainbow's place.
TEST(HazeOptics, PolarizesAlongThePlaneInTheRainbow) {
  const HazeOptics optics = HazeOpticsAt(450.0);
  EXPECT_LT(Polynomial(optics.polarized, Argument(0.5 * pi)), 0.0);
  EXPECT_GT(Polynomial(optics.polarized, Argument(140.0 * pi / 180.0)), 0.0);
}

}  // namespace
}  // namespace polnav::sky
