#include "nav/stereo/disparity_zero.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "nav/stereo/reprojection.h"
#include "tests/nav/synthetic_street.h"

namespace polnav::nav {
namespace {

constexpr double kZero_px = -0.15;  // the pair's error in all tests

RectifiedCamera Camera() { return StereoRectifier(TestCalibration()).camera(); }

Eigen::Vector3d PixelsOf(const RectifiedCamera& camera, const Eigen::Vector3d& p_C) {
  const double inv = 1.0 / p_C.z();
  return {camera.f_px * p_C.x() * inv + camera.cx_px, camera.f_px * p_C.y() * inv + camera.cy_px,
          camera.f_px * camera.baseline_m * inv + kZero_px};
}

// 150 points from 2 to 30 m, seen before and after a motion of the camera.
std::vector<TwiceSeen> Scene(const Eigen::Vector3d& t_C, const Eigen::Vector3d& turn_C,
                             double noise_px, unsigned seed) {
  const RectifiedCamera camera = Camera();
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> inverse_depth(1.0 / 30.0, 0.5);
  std::uniform_real_distribution<double> side(-0.8, 0.8);
  std::normal_distribution<double> noise(0.0, noise_px);
  const Eigen::Matrix3d R = ExpRotation(turn_C).toRotationMatrix();
  std::vector<TwiceSeen> points;
  while (points.size() < 150) {
    const double depth = 1.0 / inverse_depth(random);
    const Eigen::Vector3d p(side(random) * depth, 0.5 * side(random) * depth, depth);
    const Eigen::Vector3d q = R * p + t_C;
    if (q.z() < 0.7) continue;
    TwiceSeen point{PixelsOf(camera, p), PixelsOf(camera, q)};
    for (int i = 0; i < 3; ++i) {
      point.before(i) += noise(random);
      point.after(i) += noise(random);
    }
    points.push_back(point);
  }
  return points;
}

const Eigen::Vector3d kForward(0.02, 0.01, -1.0);
const Eigen::Vector3d kTurn(0.003, 0.02, -0.002);

TEST(DisparityZero, FollowsExactlyFromExactPoints) {
  const ZeroMeasurement z = MeasureZero(Camera(), Scene(kForward, kTurn, 0.0, 1), 0.3, 0.0);
  // The faint pull of 1e-6 of information towards where the last step stood is all there is.
  EXPECT_NEAR(z.zero_px, kZero_px, 1e-4);
}

TEST(DisparityZero, NoiseIsAsLargeAsItSays) {
  double sum = 0.0;
  constexpr int kTrials = 40;
  for (int trial = 0; trial < kTrials; ++trial) {
    const ZeroMeasurement z =
        MeasureZero(Camera(), Scene(kForward, kTurn, 0.2, 10 + trial), 0.2, 0.0);
    sum += std::pow((z.zero_px - kZero_px) / z.sigma_px, 2);
  }
  // Chi-square over 40: standard deviation 0.22; Cauchy's weights take some information away, which
  // the sigma counts, and add some spread, which it does not.
  EXPECT_GT(sum / kTrials, 0.4);
  EXPECT_LT(sum / kTrials, 2.0);
}

TEST(DisparityZero, DoesNotHeedTheFifthThatMovesByItself) {
  std::vector<TwiceSeen> points = Scene(kForward, kTurn, 0.1, 3);
  for (std::size_t i = 0; i < points.size(); i += 5) points[i].after += Eigen::Vector3d(25, 3, 2);
  const ZeroMeasurement z = MeasureZero(Camera(), points, 0.3, 0.0);
  EXPECT_NEAR(z.zero_px, kZero_px, 3.0 * z.sigma_px);
}

TEST(DisparityZero, TurningOnTheSpotTellsNothing) {
  const ZeroMeasurement z =
      MeasureZero(Camera(), Scene(Eigen::Vector3d::Zero(), {0.0, 0.05, 0.0}, 0.1, 4), 0.3, 0.0);
  const ZeroMeasurement driving = MeasureZero(Camera(), Scene(kForward, kTurn, 0.1, 4), 0.3, 0.0);
  EXPECT_GT(z.sigma_px, 20.0 * driving.sigma_px);
}

StereoFeatures FeaturesOf(const std::vector<TwiceSeen>& points, bool after, TimeNs stamp) {
  StereoFeatures features{.stamp = stamp};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d& p = after ? points[i].after : points[i].before;
    features.features.push_back({.id = i, .uv_left_px = p.head<2>(), .u_right_px = p.x() - p.z()});
  }
  return features;
}

// With as much to be expected of the one as of the other, z gets half of what the pairs say; with
// nothing in common expected, nearly all.
TEST(DisparityZero, IsSharedOutBetweenThePairAndTheMethod) {
  for (const double systematic_px : {0.1, 0.0}) {
    DisparityZero zero({.sigma_px = 0.1, .systematic_px = systematic_px}, Camera());
    for (int i = 0; i < 60; ++i) {
      const std::vector<TwiceSeen> points =
          Scene(kForward, kTurn, 0.1, 100U + static_cast<unsigned>(i));
      zero.Add({.stamp = 3 * i});  // the points before are others
      zero.Add(FeaturesOf(points, false, 3 * i + 1));
      zero.Add(FeaturesOf(points, true, 3 * i + 2));
    }
    // 60 pairs of 0.1 px leave 0.013 px.
    EXPECT_NEAR(zero.zero_px(), kZero_px / (systematic_px > 0.0 ? 2.0 : 1.0), 0.04);
  }
}

TEST(DisparityZero, StandingStillAndSwitchedOffItStaysZero) {
  const std::vector<TwiceSeen> points = Scene(kForward, kTurn, 0.1, 7);
  DisparityZero standing({}, Camera());
  DisparityZero off({.sigma_px = 0.0}, Camera());
  for (int i = 0; i < 10; ++i) {
    standing.Add(FeaturesOf(points, false, i));
    off.Add(FeaturesOf(points, i % 2 == 1, i));
  }
  EXPECT_EQ(standing.zero_px(), 0.0);
  EXPECT_EQ(off.zero_px(), 0.0);
}

}  // namespace
}  // namespace polnav::nav
