#include "sky/haze_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sky/haze_scattering.h"

namespace polnav::sky {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// [Hansen1974] as tabulated by [Bodhaine1999] for 1013 hPa: 0.0973 at 550 nm, 0.2194 at 450; ours
// is two percent lower, as OSOAA's grid has it.
TEST(HazeAirOf, HasTheMoleculesOfTheWholeAtmosphere) {
  EXPECT_NEAR(HazeAirOf(0.0, 550.0).molecules, 0.0973, 0.003);
  EXPECT_NEAR(HazeAirOf(0.0, 450.0).molecules, 0.2194, 0.006);
  EXPECT_EQ(HazeAirOf(0.0, 450.0).haze, 0.0);
  EXPECT_NEAR(HazeAirOf(0.3, 550.0).haze, 0.3, 1e-15);
}

// Thin air of thickness tau scatters sunlight once: along mu, sunlight times tau / mu times the
// phase function over 4 pi. What is scattered twice, or by the sea's light, is of the next order
// and adds; at tau = 1e-6 under a high sun over a dark sea, a fifth at most.
TEST(HazeField, OfThinAirIsSingleScattering) {
  const double tau = 1e-6;
  const double elevation = 60.0 * kDegree;
  const HazeField field({.molecules = tau, .haze = 0.0, .water_albedo = 0.0, .optics = {}},
                        elevation);
  for (const double mu : {0.3, 0.8}) {
    const HazeRay ray = field.Along(mu);
    // Of p12 = -3 / 4 sin^2, what goes with twice the azimuth.
    const double flat_sun = std::cos(elevation);
    const double single = -3.0 / 4.0 * 0.5 * flat_sun * flat_sun * (1.0 + mu * mu) /
                          (4.0 * std::numbers::pi) * tau / mu;
    EXPECT_NEAR(ray.q[2] / single, 1.0, 0.1);
    EXPECT_EQ(ray.sun, 0.0);
  }
}

// Light goes as the optical thickness where both are small.
TEST(HazeField, IsLinearInThinAir) {
  const HazeOptics optics = HazeOpticsAt(550.0);
  const HazeRay once = HazeField({1e-5, 1e-5, 0.0, optics}, 0.8).Along(0.5);
  const HazeRay twice = HazeField({2e-5, 2e-5, 0.0, optics}, 0.8).Along(0.5);
  EXPECT_NEAR(twice.i[0] / once.i[0], 2.0, 1e-3);
  EXPECT_NEAR(twice.q[2] / once.q[2], 2.0, 1e-3);
  EXPECT_NEAR(twice.sun / once.sun, 2.0, 1e-3);
}

// Near the horizon a ray's way is long and ends in the air next to the eye: finite light.
TEST(HazeField, IsFiniteTowardsTheHorizon) {
  const HazeField field(HazeAirOf(0.3, 450.0), 0.3);
  const HazeRay low = field.Along(1e-4);
  const HazeRay lower = field.Along(5e-5);
  EXPECT_NEAR(low.i[0], lower.i[0], 0.01 * low.i[0]);
  EXPECT_NEAR(low.q[2], lower.q[2], 0.01 * std::abs(low.q[2]));
}

// Of a sun's irradiance, what a conservative sky sends to a black ground is less than what was
// taken from the beam, and more than half of it: scattering by air is even up and down.
TEST(HazeField, SendsDownMoreThanHalfOfWhatItScatters) {
  const double elevation = 50.0 * kDegree;
  const HazeAir air{.molecules = 0.1, .haze = 0.0, .water_albedo = 0.0, .optics = {}};
  const HazeField field(air, elevation);
  const double taken = std::sin(elevation) * (1.0 - std::exp(-air.molecules / std::sin(elevation)));
  double flux = 0.0;  // of the part without azimuth, which alone has any
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i) {
    const double mu = (i + 0.5) / kSteps;
    flux += 2.0 * std::numbers::pi * mu * field.Along(mu).i[0] / kSteps;
  }
  EXPECT_LT(flux, 0.6 * taken);
  EXPECT_GT(flux, 0.45 * taken);
}

}  // namespace
}  // namespace polnav::sky
