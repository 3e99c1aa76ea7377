#include "sim/sensors/feature_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/calib3d.hpp>
#include <set>

#include "tests/sim/sensors/feature_scene.h"

namespace polnav::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// By OpenCV's models of the same names, from the scene's coordinates on.
Vector2d Project(const nav::CameraCalibration& camera, const nav::Pose& T_WB, const Vector3d& p_W) {
  const Vector3d p_C = (T_WB * camera.T_BC).Inverse() * p_W;
  const std::vector<cv::Point3d> points = {{p_C.x(), p_C.y(), p_C.z()}};
  const cv::Matx33d K(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  const cv::Vec4d k(camera.distortion.data());
  std::vector<cv::Point2d> pixels;
  if (camera.model == nav::DistortionModel::kEquidistant) {
    cv::fisheye::projectPoints(points, pixels, cv::Vec3d(), cv::Vec3d(), K, k);
  } else {
    cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), K, k, pixels);
  }
  return {pixels[0].x, pixels[0].y};
}

Scene OneWall(double east_m = 10.0, double half_side_m = 30.0) {
  Scene scene;
  scene.meshes = {WallAt(east_m, half_side_m)};
  return scene;
}

// A square of 1.6 m that crosses from north to south five metres ahead, so fast.
Actor Passer(double share_of_4_m_s) {
  Actor passer{.name = "passer", .meshes = {WallAt(0.0, 0.8)}};
  for (const double way : {0.0, 0.5, 1.0}) {
    nav::Pose T_WA;
    T_WA.p = {5.0, 4.0 - 8.0 * way, 0.0};
    passer.path.push_back({nav::FromSeconds(2.0 * way / share_of_4_m_s), T_WA});
  }
  return passer;
}

void ExpectExactProjections(const StereoCameraOptions& options) {
  Scene scene = OneWall();
  scene.meshes.push_back(WallAt(6.0, 1.0, -2.0));
  scene.actors = {Passer(1.0)};
  FeatureRig rig(scene, options);
  std::size_t pairs = 0;
  std::size_t on_actor = 0;
  for (int i = 0; i < 10; ++i) {
    const nav::Pose T_WB{Eigen::Quaterniond(Eigen::AngleAxisd(0.02 * i, Vector3d::UnitZ())),
                         {0.2 * i, -0.05 * i, 0.01 * i}};
    for (const FeatureSighting& s : rig.Next(T_WB).sightings) {
      const Vector3d p = rig.PlaceOf(s.point);
      EXPECT_LT((s.left_px - Project(rig.truth.left, T_WB, p)).norm(), 1e-6);
      if (s.right_px) {
        EXPECT_LT((*s.right_px - Project(rig.truth.right, T_WB, p)).norm(), 1e-6);
        ++pairs;
      }
      if (rig.ActorOf(s.point) == 0) ++on_actor;
    }
  }
  EXPECT_GT(pairs, 1000U);
  EXPECT_GT(on_actor, 10U);
}

TEST(FeatureCamera, SeesPointsWhereTheTrueCalibrationProjectsThem) {
  ExpectExactProjections(FaultlessOptions());
}

TEST(FeatureCamera, SeesPointsThroughAnEquidistantLensToo) {
  StereoCameraOptions options = FaultlessOptions();
  options.model = "equidistant";
  options.k1 = -0.02;
  options.k2 = 0.003;
  ExpectExactProjections(options);
}

// The near wall covers what it covers on the far one, by similar triangles from each eye.
TEST(FeatureCamera, DoesNotSeeWhatIsBehindAWall) {
  StereoCameraOptions options = FaultlessOptions();
  options.features.max_features = 2000;
  options.features.grid_columns = 100;
  options.features.grid_rows = 100;
  options.features.points_per_sr = 20000.0;
  Scene scene = OneWall(10.0);
  scene.meshes.push_back(WallAt(5.0, 1.0));
  FeatureRig rig(scene, options);
  const auto is_behind = [](const Vector3d& p, double eye_north_m) {
    const double north = eye_north_m + 0.5 * (p.y() - eye_north_m);  // where its ray meets 5 m
    return p.x() > 9.0 && std::abs(north) < 1.0 && std::abs(0.5 * p.z()) < 1.0;
  };
  int near = 0;
  int only_left = 0;
  for (const FeatureSighting& s : rig.Next().sightings) {
    const Vector3d p = rig.PlaceOf(s.point);
    EXPECT_FALSE(is_behind(p, 0.06)) << p.transpose();
    if (p.x() < 6.0) ++near;
    if (!is_behind(p, -0.06)) continue;
    ++only_left;
    EXPECT_FALSE(s.right_px) << p.transpose();
  }
  // Of the picture's 250,000 square pixels the near wall takes 140 x 140.
  EXPECT_GT(near, 80);
  EXPECT_GT(only_left, 0) << "the right eye looks less far around the wall's left edge";
}

// It covers a point for twenty frames, by similar triangles. A track is looked after every
// fifth frame, so that none is seen through the passer for five.
TEST(FeatureCamera, LosesWhatAnActorCoversAndGivesItANewIdAfterwards) {
  Scene scene = OneWall();
  scene.actors = {Passer(0.2)};
  FeatureRig rig(scene);
  std::map<std::uint32_t, std::uint64_t> first_id;
  std::map<std::uint64_t, int> covered_for;
  std::set<std::uint32_t> again;
  constexpr int kGone = 100;
  for (int i = 0; i < kGone + 12; ++i) {
    for (const FeatureSighting& s : rig.Next().sightings) {
      const auto [entry, is_new] = first_id.try_emplace(s.point, s.id);
      if (entry->second != s.id) again.insert(s.point);
      const Vector3d p = rig.PlaceOf(s.point);
      EXPECT_TRUE(i <= kGone || p.x() > 9.0) << "it has gone";
      const double middle = 4.0 - 8.0 * i / kGone;
      const bool covered = i <= kGone && p.x() > 9.0 && std::abs(0.5 * p.z()) < 0.79 &&
                           std::abs(0.06 + 0.5 * (p.y() - 0.06) - middle) < 0.79;
      int& frames = covered_for[s.id];
      frames = covered ? frames + 1 : 0;
      EXPECT_LT(frames, 5) << s.id;
    }
  }
  EXPECT_GT(again.size(), 5U);
}

TEST(FeatureCamera, KeepsIdsWhileTheVehicleStandsAndNothingIsLost) {
  FeatureRig rig(OneWall());
  const FeatureSightings first = rig.Next();
  for (int i = 0; i < 20; ++i) {
    const FeatureSightings now = rig.Next();
    ASSERT_EQ(now.sightings.size(), first.sightings.size());
    for (std::size_t k = 0; k < now.sightings.size(); ++k) {
      EXPECT_EQ(now.sightings[k].id, first.sightings[k].id);
      EXPECT_EQ(now.sightings[k].left_px, first.sightings[k].left_px);
    }
  }
}

// A wall fills the whole picture: two points in each of 16 x 9 cells.
TEST(FeatureCamera, SpreadsPointsOverTheImage) {
  FeatureRig rig(OneWall());
  std::map<int, int> cells;
  const FeatureSightings seen = rig.Next();
  for (const FeatureSighting& s : seen.sightings) {
    ++cells[static_cast<int>(s.left_px.y() * 9 / 376) * 16 +
            static_cast<int>(s.left_px.x() * 16 / 672)];
  }
  EXPECT_LE(seen.sightings.size(), 288U);
  EXPECT_GT(cells.size(), 130U) << "of 144; with five points a cell on the mean few are empty";
  for (const auto& [cell, count] : cells) EXPECT_LE(count, 2);
}

TEST(FeatureCamera, SeesTheFrontOfSurfacesOnly) {
  Scene scene = OneWall();
  std::swap(scene.meshes[0].indices[1], scene.meshes[0].indices[2]);
  std::swap(scene.meshes[0].indices[4], scene.meshes[0].indices[5]);
  FeatureRig rig(scene);
  EXPECT_TRUE(rig.Next().sightings.empty());
}

TEST(FeatureCamera, SameSeedSameSightings) {
  StereoCameraOptions options = FaultlessOptions();
  options.features = FeatureOptions{};
  FeatureRig one(OneWall(), options, 5);
  FeatureRig two(OneWall(), options, 5);
  FeatureRig other(OneWall(), options, 6);
  bool differs = false;
  for (int i = 0; i < 5; ++i) {
    const FeatureSightings a = one.Next();
    const FeatureSightings b = two.Next();
    const FeatureSightings c = other.Next();
    ASSERT_EQ(a.sightings.size(), b.sightings.size());
    for (std::size_t k = 0; k < a.sightings.size(); ++k) {
      EXPECT_EQ(a.sightings[k].id, b.sightings[k].id);
      EXPECT_EQ(a.sightings[k].left_px, b.sightings[k].left_px);
      EXPECT_EQ(a.sightings[k].right_px, b.sightings[k].right_px);
      EXPECT_EQ(a.sightings[k].descriptor, b.sightings[k].descriptor);
    }
    differs = differs || a.sightings.size() != c.sightings.size() ||
              a.sightings[0].left_px != c.sightings[0].left_px;
  }
  EXPECT_TRUE(differs);
}

// Losses of each kind within three sigmas of the binomial.
TEST(FeatureCamera, LosesAsManyAsAskedFor) {
  StereoCameraOptions options = FaultlessOptions();
  options.features.loss_probability = 0.1;
  options.features.right_loss_probability = 0.2;
  FeatureRig rig(OneWall(), options);
  std::set<std::uint64_t> before;
  double lost = 0.0;
  double chances = 0.0;
  double no_right = 0.0;
  double seen = 0.0;
  for (int i = 0; i < 40; ++i) {
    std::set<std::uint64_t> now;
    for (const FeatureSighting& s : rig.Next().sightings) {
      now.insert(s.id);
      // Near the left edge of the left picture the right one has no place for a point.
      if (s.left_px.x() < 20.0) continue;
      ++seen;
      if (!s.right_px) ++no_right;
    }
    for (const std::uint64_t id : before) lost += now.contains(id) ? 0.0 : 1.0;
    chances += static_cast<double>(before.size());
    before = now;
  }
  EXPECT_NEAR(lost / chances, 0.1, 3.0 * std::sqrt(0.1 * 0.9 / chances));
  EXPECT_NEAR(no_right / seen, 0.2, 3.0 * std::sqrt(0.2 * 0.8 / seen));
}

}  // namespace
}  // namespace polnav::sim
