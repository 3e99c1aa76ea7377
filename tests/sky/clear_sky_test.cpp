#include "sky/clear_sky.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sky/sun.h"

namespace polnav::sky {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

struct Row {
  double sun_deg, elevation_deg, azimuth_from_sun_deg, angle_deg, dop;
};

// In a map of the sky about the zenith axis 1 is radial and axis 2 across it.
void ExpectRow(const ClearSky& sky, const Row& row) {
  const RayAxes axes = AxesOf(
      DirectionEnu((40.0 + row.azimuth_from_sun_deg) * kDegree, row.elevation_deg * kDegree));
  const SkyStokes<double> light = sky.Look(axes);
  EXPECT_NEAR(std::hypot(light.q, light.u), row.dop, 1e-6);
  const double azimuth = std::atan2(-axes.axis2_W.y(), axes.axis2_W.x());
  const double angle_deg = (azimuth + 0.5 * std::atan2(light.u, light.q)) / kDegree;
  EXPECT_NEAR(std::remainder(angle_deg - row.angle_deg, 180.0), 0.0, 1e-4);
}

// Sky vectors of another program (OpenSky), printed to 1e-4 degrees and 1e-6; sun at azimuth 40.
TEST(ClearSky, AgreesWithAnIndependentRayleighSky) {
  for (const Row& row : {Row{30, 90, 0, -50, 0.6}, Row{30, 60, 90, -66.1021, 0.684211},
                         Row{30, 45, 135, -57.0978, 0.987452}, Row{10, 30, 60, -73.5898, 0.582987},
                         Row{60, 20, 180, -50, 0.941458}}) {
    ExpectRow(ClearSky({.model = "rayleigh", .max_dop = 1.0},
                       DirectionEnu(40.0 * kDegree, row.sun_deg * kDegree)),
              row);
  }
}

// Its delta of 15 degrees is the distance of either point from the sun: half the separation.
TEST(ClearSky, AgreesWithAnIndependentBerrySky) {
  for (const Row& row : {Row{30, 90, 0, -50, 0.518618}, Row{30, 60, 90, -67.0979, 0.626617},
                         Row{30, 45, 135, -56.9576, 0.893347}, Row{10, 30, 60, -74.7290, 0.580769},
                         Row{60, 20, 180, -50, 0.822920}}) {
    const double sun_rad = row.sun_deg * kDegree;
    ClearSkyOptions options{.model = "berry", .max_dop = 1.0};
    options.separation_scale = 15.0 * kDegree / BerryHalfSeparation(sun_rad, options.aot);
    ExpectRow(ClearSky(options, DirectionEnu(40.0 * kDegree, sun_rad)), row);
  }
}

// With the sun at or below the horizon the sky stays a number, and goes on from where it was.
TEST(ClearSky, AnswersTwilightAndNight) {
  for (const char* model : {"rayleigh", "berry", "hazy"}) {
    for (const double sun_deg : {0.0, -3.0, -18.0, -90.0}) {
      const ClearSky sky({.model = model}, DirectionEnu(1.0, sun_deg * kDegree));
      for (double elevation = 0.0; elevation <= 90.0; elevation += 10.0) {
        const SkyStokes<double> light = sky.Look(DirectionEnu(2.0, elevation * kDegree));
        EXPECT_TRUE(std::isfinite(light.radiance)) << model;
        EXPECT_GT(light.radiance, 0.0) << model;
        EXPECT_LE(std::hypot(light.q, light.u), 1.0) << model;
      }
    }
    const Eigen::Vector3d ray = DirectionEnu(2.0, 0.5);
    const SkyStokes<double> above = ClearSky({.model = model}, DirectionEnu(1.0, 1e-6)).Look(ray);
    const SkyStokes<double> below = ClearSky({.model = model}, DirectionEnu(1.0, -1e-6)).Look(ray);
    EXPECT_NEAR(above.q, below.q, 1e-5) << model;
    EXPECT_NEAR(above.radiance, below.radiance, 1e-4) << model;
  }
}

TEST(ClearSky, IsOneAtTheZenith) {
  for (const char* model : {"rayleigh", "berry", "hazy"}) {
    const ClearSky sky({.model = model}, DirectionEnu(1.0, 0.6));
    EXPECT_NEAR(sky.Look(Eigen::Vector3d::UnitZ()).radiance, 1.0, 1e-12) << model;
  }
}

TEST(ClearSky, RefusesAnUnknownModelAndABrokenSun) {
  EXPECT_THROW(ClearSky({.model = "perez"}, Eigen::Vector3d::UnitZ()), std::invalid_argument);
  EXPECT_THROW(ClearSky({}, Eigen::Vector3d(0.0, 0.0, 2.0)), std::logic_error);
}

}  // namespace
}  // namespace polnav::sky
