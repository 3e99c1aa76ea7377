#include "tools/testbed/sightings.h"

#include <gtest/gtest.h>

#include "sim/sensors/lens.h"
#include "sim/sensors/stereo_camera.h"

namespace polnav::testbed {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A pair as the estimators believe it to be, its right camera a little askew.
nav::StereoCalibration Nominal() {
  nav::StereoCalibration pair = sim::NominalStereo({});
  pair.right.T_BC.q = pair.right.T_BC.q * Eigen::AngleAxisd(0.01, Vector3d(1.0, 2.0, 2.0) / 3.0);
  return pair;
}

Vector2d Seen(const nav::CameraCalibration& camera, const Vector3d& p_B) {
  return sim::ProjectToPixel(camera, camera.T_BC.Inverse() * p_B);
}

sim::FeatureSightings SightingsOf(const std::vector<Vector3d>& points_B) {
  const nav::StereoCalibration pair = Nominal();
  sim::FeatureSightings seen{.stamp = 5, .sightings = {}};
  for (std::size_t i = 0; i < points_B.size(); ++i) {
    seen.sightings.push_back({.id = 10 + i,
                              .left_px = Seen(pair.left, points_B[i]),
                              .right_px = Seen(pair.right, points_B[i])});
    seen.sightings.back().descriptor.fill(static_cast<std::uint8_t>(i));
  }
  return seen;
}

const std::vector<Vector3d>& Points() {
  static const std::vector<Vector3d> points = {
      {5.0, 1.0, 0.5}, {10.0, -4.0, 3.0}, {40.0, 3.0, 2.0}, {4.0, 0.0, 0.0}};
  return points;
}

// [Chu2021, eqs 13-15] in the virtual pair: u = f X / Z + cx, u_left - u_right = b f / Z. The
// rectifier stops its iterations at 1e-3 px.
TEST(Sightings, MeanThePointInTheRectifiedPair) {
  const nav::RectifiedCamera camera = nav::StereoRectifier(Nominal()).camera();
  const nav::StereoFeatures features =
      SightingsRectifier({}, Nominal(), false).Rectify(SightingsOf(Points()));
  ASSERT_EQ(features.features.size(), Points().size());
  EXPECT_EQ(features.stamp, 5);
  EXPECT_TRUE(features.descriptors.empty());
  for (std::size_t i = 0; i < Points().size(); ++i) {
    const Vector3d p_C = camera.T_BC.Inverse() * Points()[i];
    const nav::FeatureObservation& f = features.features[i];
    EXPECT_EQ(f.id, 10 + i);
    EXPECT_NEAR(f.uv_left_px.x(), camera.f_px * p_C.x() / p_C.z() + camera.cx_px, 5e-3);
    EXPECT_NEAR(f.uv_left_px.y(), camera.f_px * p_C.y() / p_C.z() + camera.cy_px, 5e-3);
    ASSERT_TRUE(f.u_right_px);
    EXPECT_NEAR(f.uv_left_px.x() - *f.u_right_px, camera.baseline_m * camera.f_px / p_C.z(), 5e-3);
  }
}

TEST(Sightings, WhatIsOffItsRowIsNoMatch) {
  sim::FeatureSightings seen = SightingsOf(Points());
  seen.sightings[0].right_px->y() += 3.0;
  seen.sightings[1].right_px->x() += 60.0;  // behind infinity
  seen.sightings[2].right_px->x() -= 200.0;
  seen.sightings[3].right_px.reset();
  const nav::StereoFeatures features = SightingsRectifier({}, Nominal(), false).Rectify(seen);
  ASSERT_EQ(features.features.size(), 4U);
  for (const nav::FeatureObservation& f : features.features) EXPECT_FALSE(f.u_right_px) << f.id;
}

TEST(Sightings, CarryDescriptorsWhereSomebodyWantsThem) {
  const nav::StereoFeatures features =
      SightingsRectifier({}, Nominal(), true).Rectify(SightingsOf(Points()));
  ASSERT_EQ(features.descriptors.type(), CV_8UC1);
  ASSERT_EQ(features.descriptors.size(), cv::Size(32, 4));
  for (int row = 0; row < 4; ++row) {
    for (int col = 0; col < 32; ++col)
      EXPECT_EQ(features.descriptors.at<std::uint8_t>(row, col), row);
  }
}

TEST(Sightings, AreNoNewsWhenNothingChangedOrTheyAreLate) {
  const SightingsRectifier rectifier({}, Nominal(), false);
  const nav::StereoFeatures first = rectifier.Rectify(SightingsOf(Points()));
  nav::StereoFeatures frozen = first;
  EXPECT_FALSE(IsNews(first, first));
  frozen.stamp = 6;
  EXPECT_FALSE(IsNews(frozen, first));
  frozen.features[2].uv_left_px.x() += 1e-9;
  EXPECT_TRUE(IsNews(frozen, first));
  frozen.stamp = 4;
  EXPECT_FALSE(IsNews(frozen, first));
  EXPECT_TRUE(IsNews({.stamp = 7}, {.stamp = 6})) << "darkness goes on";
}

}  // namespace
}  // namespace polnav::testbed
