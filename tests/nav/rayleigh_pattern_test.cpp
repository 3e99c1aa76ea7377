#include "nav/polarization/rayleigh_pattern.h"

#include <gtest/gtest.h>

#include <cmath>

namespace polnav::nav {
namespace {

constexpr double kElevation_rad = 0.5;

// Rays all over the upper sky, their axes turned about the ray by some angle.
SkyBlocks Rays() {
  constexpr int kCount = 40;
  SkyBlocks sky;
  for (Array3Xf* const axis : {&sky.x, &sky.y, &sky.z}) axis->resize(kCount, 3);
  sky.q.resize(kCount);
  sky.u.resize(kCount);
  for (int i = 0; i < kCount; ++i) {
    const Eigen::Quaterniond q(Eigen::AngleAxisd(2.4 * i, Eigen::Vector3d::UnitZ()) *
                               Eigen::AngleAxisd(0.03 * i, Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(0.7 * i, Eigen::Vector3d::UnitZ()));
    sky.x.row(i) = (q * Eigen::Vector3d::UnitX()).cast<float>().transpose().array();
    sky.y.row(i) = (q * Eigen::Vector3d::UnitY()).cast<float>().transpose().array();
    sky.z.row(i) = (q * Eigen::Vector3d::UnitZ()).cast<float>().transpose().array();
    sky.q[i] = 0.3F * std::cos(1.3F * static_cast<float>(i));
    sky.u[i] = 0.3F * std::sin(1.7F * static_cast<float>(i));
  }
  return sky;
}

RayleighPattern::Values At(const SkyBlocks& sky, double angle_rad) {
  RayleighPattern::Values values;
  RayleighPattern(sky, kElevation_rad).At(angle_rad, values);
  return values;
}

// The E-vector is perpendicular to ray and sun [Chu2021, eqs 5-7].
TEST(RayleighPattern, IsPerpendicularToRayAndSun) {
  const SkyBlocks sky = Rays();
  const double angle = 1.1;
  const RayleighPattern::Values values = At(sky, angle);
  const Eigen::Vector3f sun =
      Eigen::Vector3d(std::cos(kElevation_rad) * std::cos(angle),
                      std::cos(kElevation_rad) * std::sin(angle), std::sin(kElevation_rad))
          .cast<float>();
  for (Eigen::Index i = 0; i < sky.size(); ++i) {
    const float axis = 0.5F * std::atan2(values.my[i], values.mx[i]);
    const Eigen::Vector3f e = std::cos(axis) * sky.x.row(i).matrix().transpose() +
                              std::sin(axis) * sky.y.row(i).matrix().transpose();
    EXPECT_NEAR(e.dot(sun), 0.0F, 1e-5F) << i;
  }
}

// Floats hold 1e-7, a step of 1e-3 makes 1e-4 of that; the second derivative is below 100.
TEST(RayleighPattern, DerivativeOfTheResidualAgreesWithFiniteDifferences) {
  const SkyBlocks sky = Rays();
  constexpr double kStep = 1e-3;
  const RayleighPattern::Values values = At(sky, 0.4);
  const Eigen::ArrayXf slope =
      (At(sky, 0.4 + kStep).across - At(sky, 0.4 - kStep).across) / static_cast<float>(2.0 * kStep);
  EXPECT_LT((slope + values.turn * values.along).abs().maxCoeff(), 2e-3F);
}

TEST(RayleighPattern, TurnAboutTheVerticalIsTheAnglesOwnDerivative) {
  const SkyBlocks sky = Rays();
  const RayleighPattern pattern(sky, kElevation_rad);
  const RayleighPattern::Values values = At(sky, -2.0);
  const Eigen::ArrayXf turn = pattern.TurnBySun(-2.0).col(2);
  EXPECT_LT((turn - values.turn).abs().maxCoeff(), 1e-4F);
}

// Light polarized vertically is seen as it is: along the vertical's own direction it is all along.
TEST(RayleighPattern, VerticalLightIsAsLongAsTheSquareOfTheElevationsCosine) {
  const SkyBlocks sky = Rays();
  const RayleighPattern pattern(sky, kElevation_rad);
  RayleighPattern::Values values = At(sky, 0.9);
  const Eigen::ArrayXf across = pattern.VerticalAcross(values);
  // The same light along Rayleigh's direction: turned by a right angle in the (q, u) plane.
  values.my = -values.my;
  std::swap(values.mx, values.my);
  const Eigen::ArrayXf along = pattern.VerticalAcross(values);
  const Eigen::ArrayXf cosine2 = 1.0F - sky.z.col(2).square();
  EXPECT_LT(((across.square() + along.square()).sqrt() - cosine2).abs().maxCoeff(), 1e-5F);
}

}  // namespace
}  // namespace polnav::nav
