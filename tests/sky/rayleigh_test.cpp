#include "sky/rayleigh.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "sky/sun.h"

namespace polnav::sky {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

Eigen::Vector3d SunInP(double angle_from_ray, double azimuth) {
  return {std::sin(angle_from_ray) * std::cos(azimuth),
          std::sin(angle_from_ray) * std::sin(azimuth), std::cos(angle_from_ray)};
}

// z is the ray; the E-vector lies in the x-y plane, at half the phase of (Q, U).
TEST(RayleighStokes, TheEVectorIsPerpendicularToSunAndRay) {
  for (double angle = 0.1; angle < 3.1; angle += 0.2) {
    for (double azimuth = 0.0; azimuth < 6.3; azimuth += 0.3) {
      const Eigen::Vector3d s = SunInP(angle, azimuth);
      const Eigen::Vector2d stokes = RayleighStokes<double>(s, 0.7);
      const double phi = 0.5 * std::atan2(stokes.y(), stokes.x());
      EXPECT_NEAR(Eigen::Vector3d(std::cos(phi), std::sin(phi), 0.0).dot(s), 0.0, 1e-14);
    }
  }
}

TEST(RayleighStokes, IsUnpolarizedAtSunAndAntisunAndFullAcross) {
  EXPECT_EQ(RayleighStokes<double>(SunInP(0.0, 0.0), 1.0).norm(), 0.0);
  EXPECT_LT(RayleighStokes<double>(SunInP(std::numbers::pi, 0.0), 1.0).norm(), 1e-30);
  EXPECT_NEAR(RayleighStokes<double>(SunInP(0.5 * std::numbers::pi, 0.3), 0.8).norm(), 0.8, 1e-15);
}

// Zenith ray, sun due east on the horizon, x east: polarized along north.
TEST(RayleighStokes, PointsNorthUnderAnEasternSun) {
  const Eigen::Vector2d stokes = RayleighStokes<double>(Eigen::Vector3d::UnitX(), 1.0);
  EXPECT_DOUBLE_EQ(stokes.x(), -1.0);
  EXPECT_DOUBLE_EQ(stokes.y(), 0.0);
}

// Scattering into a ray is the same backwards: sun and antisun cannot be told apart.
TEST(RayleighStokes, CannotTellSunFromAntisun) {
  const Eigen::Vector3d s = SunInP(0.7, 1.9);
  EXPECT_EQ(RayleighStokes<double>(s, 0.7), RayleighStokes<double>(-s, 0.7));
}

// Where atan2 and acos would give infinite derivatives, this has the finite ones of central
// differences: exact to h^2 = 1e-8.
TEST(RayleighStokes, HasFiniteDerivativesAtTheSun) {
  using Jet = ceres::Jet<double, 2>;
  const auto sun = [](const auto& x, const auto& y) {
    using T = std::decay_t<decltype(x)>;
    return Eigen::Matrix<T, 3, 1>(x, y, sqrt(T(1.0) - x * x - y * y));
  };
  for (const Eigen::Vector2d& at : {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(0.2, -0.4)}) {
    const auto jet = RayleighStokes<Jet>(sun(Jet(at.x(), 0), Jet(at.y(), 1)), 0.7);
    constexpr double kStep = 1e-4;
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(k);
      const Eigen::Vector2d difference =
          (RayleighStokes<double>(sun(at.x() + step.x(), at.y() + step.y()), 0.7) -
           RayleighStokes<double>(sun(at.x() - step.x(), at.y() - step.y()), 0.7)) /
          (2.0 * kStep);
      EXPECT_NEAR(jet[0].v[k], difference[0], 1e-7);
      EXPECT_NEAR(jet[1].v[k], difference[1], 1e-7);
    }
  }
}

// Sky vectors computed with another program (OpenSky), printed to 1e-4 degrees and 1e-6. Sun at
// azimuth 40; the angle is counted from north, clockwise, in a map of the sky about the zenith.
TEST(RayleighStokes, AgreesWithAnIndependentSky) {
  struct Row {
    double sun_elevation, elevation, azimuth_from_sun, angle, dop;
  };
  for (const Row& row : {Row{30, 90, 0, -50, 0.6}, Row{30, 60, 90, -66.1021, 0.684211},
                         Row{30, 45, 135, -57.0978, 0.987452}, Row{10, 30, 60, -73.5898, 0.582987},
                         Row{60, 20, 180, -50, 0.941458}}) {
    const double azimuth = 40.0 + row.azimuth_from_sun;
    const Eigen::Vector3d ray = DirectionEnu(azimuth * kDegree, row.elevation * kDegree);
    const Eigen::Vector3d down = DirectionEnu(azimuth * kDegree, (row.elevation - 90.0) * kDegree);
    Eigen::Matrix3d R_PW;
    R_PW << down.transpose(), ray.cross(down).transpose(), ray.transpose();
    const Eigen::Vector2d stokes = RayleighStokes<double>(
        R_PW * DirectionEnu(40.0 * kDegree, row.sun_elevation * kDegree), 1.0);
    EXPECT_NEAR(stokes.norm(), row.dop, 1e-6);
    // P's angles run against the compass, seen from below.
    const double angle = azimuth - 0.5 * std::atan2(stokes.y(), stokes.x()) / kDegree;
    EXPECT_NEAR(std::remainder(angle - row.angle, 180.0), 0.0, 1e-4);
  }
}

}  // namespace
}  // namespace polnav::sky
