#include "sky/neutral_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sky/sun.h"

namespace polnav::sky {
namespace {

using std::numbers::pi;

constexpr double kDegree = pi / 180.0;

ClearSky Sky(const std::string& model, double sun_elevation_deg, double aot = 0.0) {
  return {{.model = model, .aot = aot, .wavelength_nm = 450.0},
          DirectionEnu(1.2, sun_elevation_deg * kDegree)};
}

// Turns of the E-vector along a small circle about the point, by axes carried along with it.
double Winding(const ClearSky& sky, const Eigen::Vector3d& point, double radius_rad) {
  constexpr int kSteps = 360;
  const Eigen::Vector3d x = point.unitOrthogonal();
  const Eigen::Vector3d y = point.cross(x);
  double turned = 0.0;
  double last = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = 2.0 * pi * i / kSteps;
    const Eigen::Vector3d ray =
        (point + std::tan(radius_rad) * (std::cos(angle) * x + std::sin(angle) * y)).normalized();
    const Eigen::Vector3d x_ray = (x - x.dot(ray) * ray).normalized();
    Eigen::Matrix3d axes;
    axes << x_ray.transpose(), ray.cross(x_ray).transpose(), ray.transpose();
    const SkyStokes<double> light =
        sky.Look<double>(axes * sky.sun_W(), axes * Eigen::Vector3d::UnitZ());
    const double phase = std::atan2(light.u, light.q);
    if (i > 0) turned += std::remainder(phase - last, 2.0 * pi);
    last = phase;
  }
  return 0.5 * turned / (2.0 * pi);
}

double DopAt(const ClearSky& sky, const Eigen::Vector3d& ray) {
  const SkyStokes<double> light = sky.Look(ray);
  return std::hypot(light.q, light.u);
}

TEST(NeutralPoints, OfBerryAreFourZerosOfHalfATurnEach) {
  for (const double elevation_deg : {5.0, 20.0, 45.0}) {
    const ClearSky sky = Sky("berry", elevation_deg);
    const std::vector<NeutralPoint> points = NeutralPoints(sky);
    ASSERT_EQ(points.size(), 4U);
    for (const NeutralPoint& point : points) {
      EXPECT_LT(DopAt(sky, point.ray_W), 1e-14) << point.name;
      EXPECT_NEAR(Winding(sky, point.ray_W, 1.0 * kDegree), 0.5, 1e-9) << point.name;
    }
    // Babinet above the sun, Brewster below; Arago above the antisun.
    EXPECT_GT(points[0].ray_W.z(), sky.sun_W().z());
    EXPECT_LT(points[1].ray_W.z(), sky.sun_W().z());
    EXPECT_GT(points[2].ray_W.z(), -sky.sun_W().z());
    EXPECT_LT(points[3].ray_W.z(), -sky.sun_W().z());
  }
}

// The sphere's E-vector field turns by two in all: nothing but the four points is left to find.
TEST(NeutralPoints, OfRayleighAreTheSunAndTheAntisunOfAWholeTurn) {
  const ClearSky sky = Sky("rayleigh", 30.0);
  const std::vector<NeutralPoint> points = NeutralPoints(sky);
  ASSERT_EQ(points.size(), 2U);
  for (const NeutralPoint& point : points) {
    EXPECT_NEAR(Winding(sky, point.ray_W, 1.0 * kDegree), 1.0, 1e-9) << point.name;
  }
}

// A point's winding is +1/2 where the sky is as Babinet knew it: clear, seen in the blue.
TEST(NeutralPoints, OfHazyAreZerosOfHalfATurn) {
  for (const double elevation_deg : {10.0, 30.0, 60.0}) {
    const ClearSky sky = Sky("hazy", elevation_deg);
    const std::vector<NeutralPoint> points = NeutralPoints(sky);
    ASSERT_EQ(points.size(), 2U) << elevation_deg;
    for (const NeutralPoint& point : points) {
      EXPECT_LT(DopAt(sky, point.ray_W), 1e-12) << point.name;
      EXPECT_NEAR(Winding(sky, point.ray_W, 0.2 * kDegree), 0.5, 1e-9) << point.name;
    }
  }
  EXPECT_EQ(NeutralPoints(Sky("hazy", 10.0))[1].name, "Arago");
  EXPECT_EQ(NeutralPoints(Sky("hazy", 30.0))[0].name, "Brewster");
  EXPECT_EQ(NeutralPoints(Sky("hazy", 30.0))[1].name, "Babinet");
}

// Sign changes of Q in OSOAA's solar meridian, 450 nm without haze, from the horizon below the sun
// over the zenith; interpolated between rows 1.9 degrees apart.
TEST(NeutralPoints, OfHazyStandWhereOsoaaHasThem) {
  struct Row {
    double sun_deg, first_deg, second_deg;
  };
  for (const Row& row : {Row{10, 27.0, 169.8}, Row{30, 19.2, 36.9}, Row{60, 56.1, 62.6}}) {
    const std::vector<NeutralPoint> points = NeutralPoints(Sky("hazy", row.sun_deg));
    ASSERT_EQ(points.size(), 2U);
    const Eigen::Vector3d level = DirectionEnu(1.2, 0.0);
    const auto angle = [&](const NeutralPoint& p) {
      return std::atan2(p.ray_W.z(), p.ray_W.dot(level)) / kDegree;
    };
    EXPECT_NEAR(angle(points[0]), row.first_deg, 1.0);
    EXPECT_NEAR(angle(points[1]), row.second_deg, 1.0);
  }
}

}  // namespace
}  // namespace polnav::sky
