#include "sky/berry.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "sky/clear_sky.h"
#include "sky/sun.h"

namespace polnav::sky {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

constexpr double kDegree = pi / 180.0;

// [Berry2004] as printed: zeta = tan(zenith angle / 2) e^{i azimuth}, zeros at the two points and
// at their antipodes. The phase is fixed by symmetry: at the zenith the E-vector lies across the
// sun's vertical plane. Angles are those of the map, azimuth plus the angle from axis 1.
Complex StereographicBerry(double zenith_rad, double azimuth_rad, double sun_elevation_rad,
                           double sun_azimuth_rad, double half_rad) {
  const auto zeta = [](double zenith, double azimuth) {
    return std::tan(0.5 * zenith) * std::polar(1.0, azimuth);
  };
  const Complex z = zeta(zenith_rad, azimuth_rad);
  Complex w = -1.0;
  for (const double side : {-1.0, 1.0}) {
    const double zenith = 0.5 * pi - sun_elevation_rad + side * half_rad;
    const Complex p = zeta(zenith, sun_azimuth_rad);
    // Chords: 2 |z - p| |1 + p* z| / ((1 + |z|^2)(1 + |p|^2)) is the sine of the distance.
    w *= 2.0 * (z - p) * (1.0 + std::conj(p) * z) / ((1.0 + std::norm(z)) * (1.0 + std::norm(p)));
  }
  return w * std::polar(1.0, -2.0 * azimuth_rad);
}

TEST(BerrySky, AgreesWithItsStereographicForm) {
  for (const double sun_elevation_deg : {5.0, 30.0, 62.0}) {
    for (const double half_deg : {0.0, 4.0, 15.0, 25.0}) {
      const Eigen::Vector3d sun_W = DirectionEnu(0.7, sun_elevation_deg * kDegree);
      const BerrySky sky(0.8, half_deg * kDegree, sun_elevation_deg * kDegree);
      for (double zenith_deg = 1.0; zenith_deg < 90.0; zenith_deg += 7.0) {
        for (double azimuth = 0.05; azimuth < 6.3; azimuth += 0.4) {
          const RayAxes axes = AxesOf(DirectionEnu(azimuth, (90.0 - zenith_deg) * kDegree));
          const Eigen::Vector2d p = sky.Polarization<double>(
              axes.Components(sun_W), axes.Components(Eigen::Vector3d::UnitZ()));
          const Complex w = StereographicBerry(
              zenith_deg * kDegree, azimuth, sun_elevation_deg * kDegree, 0.7, half_deg * kDegree);
          const double dop = 0.8 * std::abs(w) / (2.0 - std::abs(w));
          EXPECT_NEAR(p.norm(), dop, 1e-13);
          // The angle to 1e-9 degrees, where there is one.
          if (dop > 1e-3) {
            const double turn = std::remainder(std::atan2(p.y(), p.x()) - std::arg(w), 2.0 * pi);
            EXPECT_NEAR(0.5 * turn / kDegree, 0.0, 1e-9);
          }
        }
      }
    }
  }
}

TEST(BerrySky, WithoutSeparationIsRayleigh) {
  const BerrySky sky(0.7, 0.0, 0.5);
  for (double from_ray = 0.0; from_ray < 3.1; from_ray += 0.2) {
    for (double turn = 0.0; turn < 6.2; turn += 0.3) {
      const Eigen::Vector3d sun(std::sin(from_ray) * std::cos(turn),
                                std::sin(from_ray) * std::sin(turn), std::cos(from_ray));
      const Eigen::Vector3d up(0.6, 0.0, 0.8);
      const Eigen::Vector2d p = sky.Polarization<double>(sun, up);
      const Eigen::Vector2d rayleigh = RayleighStokes<double>(sun, 0.7);
      EXPECT_NEAR((p - rayleigh).norm(), 0.0, 1e-15);
    }
  }
}

// About other axes across the same ray Q + i U turns by twice their angle, whatever their hand.
TEST(BerrySky, HoldsAboutAnyAxes) {
  const BerrySky sky(0.7, 0.2, 0.5);
  const RayAxes axes = AxesOf(DirectionEnu(1.0, 0.9));
  const Eigen::Vector3d sun = axes.Components(DirectionEnu(0.3, 0.5));
  const Eigen::Vector3d up = axes.Components(Eigen::Vector3d::UnitZ());
  const Eigen::Vector2d p = sky.Polarization<double>(sun, up);
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(-0.4, Eigen::Vector3d::UnitZ()));
  const Eigen::Vector2d turned = sky.Polarization<double>(turn * sun, turn * up);
  EXPECT_LT((turned - Eigen::Rotation2Dd(-0.8) * p).norm(), 1e-14);
  const Eigen::Vector3d mirror(1.0, -1.0, 1.0);
  const Eigen::Vector2d mirrored =
      sky.Polarization<double>(mirror.cwiseProduct(sun), mirror.cwiseProduct(up));
  EXPECT_LT((mirrored - Eigen::Vector2d(p.x(), -p.y())).norm(), 1e-15);
}

// Central differences of step h err by h^2 times a third derivative of order 1.
TEST(BerrySky, HasTheDerivativesThatResidualsNeed) {
  using Jet = ceres::Jet<double, 3>;
  const BerrySky sky(0.7, 0.2, 0.5);
  const Eigen::Vector3d sun = Eigen::Vector3d(0.3, -0.5, 0.4).normalized();
  const Eigen::Vector3d up(0.6, 0.0, 0.8);
  const Eigen::Matrix<Jet, 3, 1> jets(Jet(sun.x(), 0), Jet(sun.y(), 1), Jet(sun.z(), 2));
  const auto exact = sky.Polarization<Jet>(jets, up.cast<Jet>());
  constexpr double kStep = 1e-5;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(i);
    const Eigen::Vector2d slope =
        (sky.Polarization<double>(sun + step, up) - sky.Polarization<double>(sun - step, up)) /
        (2.0 * kStep);
    EXPECT_NEAR(exact.x().v[i], slope.x(), 1e-9);
    EXPECT_NEAR(exact.y().v[i], slope.y(), 1e-9);
  }
}

// OSOAA's clear sky at 450 nm has Babinet 17, 7 and 2.6 degrees above a sun of 10, 30 and 60
// (docs/hazy_sky.md). The model's two points lie the same way off, so 3 degrees is what it can do.
TEST(BerryHalfSeparation, FollowsTheSunAndHaze) {
  EXPECT_NEAR(BerryHalfSeparation(10.0 * kDegree, 0.0) / kDegree, 17.0, 3.0);
  EXPECT_NEAR(BerryHalfSeparation(30.0 * kDegree, 0.0) / kDegree, 7.0, 3.0);
  EXPECT_NEAR(BerryHalfSeparation(60.0 * kDegree, 0.0) / kDegree, 2.6, 3.0);
  double last = 2.0;
  for (double elevation = 0.0; elevation <= 90.0; elevation += 1.0) {
    const double half = BerryHalfSeparation(elevation * kDegree, 0.1);
    EXPECT_LE(half, last);
    EXPECT_LE(half, BerryHalfSeparation(elevation * kDegree, 0.3));
    last = half;
  }
  EXPECT_NEAR(last, 0.0, 1e-12);
}

}  // namespace
}  // namespace polnav::sky
