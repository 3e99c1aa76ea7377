#include "sim/sensors/feature_cloud.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/sensors/feature_scene.h"

namespace polnav::sim {
namespace {

using Eigen::Vector3d;

// How many points of the cloud an eye on the x axis could tell apart within a narrow cone about the
// point of that axis at x_m, over the cone's solid angle.
double PointsASteradian(const FeatureCloud& cloud, double eye_x_m, const Vector3d& towards) {
  constexpr double kHalfAngle = 0.2;
  const Vector3d eye(eye_x_m, 0.0, 0.0);
  double count = 0.0;
  for (const FeaturePoint& point : cloud.points) {
    const Vector3d v = point.p_m.cast<double>() - eye;
    if (v.normalized().dot(towards.normalized()) < std::cos(kHalfAngle)) continue;
    const double cosine = -v.normalized().dot(point.normal.cast<double>());
    if (cosine > 0.0 && point.reach_m > v.norm() / std::sqrt(cosine)) ++count;
  }
  return count / (2.0 * M_PI * (1.0 - std::cos(kHalfAngle)));
}

Scene WideWall() {
  Scene scene;
  scene.meshes = {WallAt(10.0, 120.0)};
  return scene;
}

// Poisson: about 0.126 sr of the wall in the cone, 2500 points, 2 % each; three sigmas, and 3 %
// because density is constant over pieces of surface.
TEST(FeatureCloud, HasAsManyPointsASteradianFromAnyDistanceAtAnySlant) {
  FeatureOptions options;
  options.points_per_sr = 20000.0;
  options.max_distance_m = 1000.0;
  const FeatureCloud cloud = DrawFeatureCloud(WideWall(), options, {Vector3d::Zero()}, 1, 0);
  const double tolerance = 0.09 * options.points_per_sr;
  const Vector3d ahead = Vector3d::UnitX();
  EXPECT_NEAR(PointsASteradian(cloud, 0.0, ahead), options.points_per_sr, tolerance);
  EXPECT_NEAR(PointsASteradian(cloud, -20.0, ahead), options.points_per_sr, tolerance);
  EXPECT_NEAR(PointsASteradian(cloud, -60.0, ahead), options.points_per_sr, tolerance);
  EXPECT_NEAR(PointsASteradian(cloud, 0.0, {1.0, 1.0, 0.0}), options.points_per_sr, tolerance);
  EXPECT_NEAR(PointsASteradian(cloud, 0.0, {1.0, 2.5, 0.0}), options.points_per_sr, tolerance);
}

TEST(FeatureCloud, PlainSurfacesHoldFewerPoints) {
  FeatureOptions options;
  const std::vector<Vector3d> eye = {Vector3d::Zero()};
  Scene scene = WideWall();
  const auto rich = static_cast<double>(DrawFeatureCloud(scene, options, eye, 1, 0).points.size());
  scene.detail = {0.1};
  const auto plain = static_cast<double>(DrawFeatureCloud(scene, options, eye, 1, 0).points.size());
  EXPECT_NEAR(plain / rich, 0.1, 3.0 * std::sqrt(0.1 / rich) + 0.01);
  scene.detail = {0.0};
  EXPECT_TRUE(DrawFeatureCloud(scene, options, eye, 1, 0).points.empty());
}

TEST(FeatureCloud, HasNoPointsFurtherAwayThanTheyAreSeen) {
  FeatureOptions options;
  options.max_distance_m = 40.0;
  const FeatureCloud cloud = DrawFeatureCloud(WideWall(), options, {Vector3d::Zero()}, 1, 0);
  double furthest = 0.0;
  for (const FeaturePoint& point : cloud.points) {
    furthest = std::max<double>(furthest, point.p_m.norm());
    EXPECT_LE(point.reach_m, 40.0F);
  }
  EXPECT_GT(furthest, 38.0);
  EXPECT_LT(furthest, 60.0) << "but for pieces of surface that are partly nearer";
}

TEST(FeatureCloud, PatchesHoldTheirPointsInOrderOfReach) {
  const FeatureCloud cloud = DrawFeatureCloud(WideWall(), {}, {Vector3d::Zero()}, 1, 0);
  std::uint32_t next = 0;
  for (const FeaturePatch& patch : cloud.patches) {
    EXPECT_EQ(patch.begin, next);
    next = patch.end;
    for (std::uint32_t i = patch.begin; i < patch.end; ++i) {
      const FeaturePoint& point = cloud.points[i];
      EXPECT_LE((point.p_m - patch.center_m).norm(), patch.radius_m * 1.0001F);
      EXPECT_TRUE(i == patch.begin || point.reach_m <= cloud.points[i - 1].reach_m);
    }
  }
  EXPECT_EQ(next, cloud.points.size());
}

}  // namespace
}  // namespace polnav::sim
