#include "sim/world/occlusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "sim/sensors/polarization_camera.h"
#include "sim/world/actor_models.h"
#include "sky/sun.h"

namespace polnav::sim {
namespace {

using Eigen::Vector3d;
using nav::DegToRad;

// A horizontal square about a point, seen from below.
Mesh Ceiling(const Vector3d& middle, double half_side, float cover = 1.0F) {
  Mesh mesh{.albedo = 1.0F, .label = Label::kStructure, .cover = cover};
  for (const auto& [x, y] : {std::pair{-1.0, -1.0}, {-1.0, 1.0}, {1.0, 1.0}, {1.0, -1.0}}) {
    mesh.vertices.push_back({(middle + half_side * Vector3d(x, y, 0.0)).cast<float>(),
                             -Eigen::Vector3f::UnitZ(), Eigen::Vector2f::Zero()});
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

double White(const Vector3d& normal_W) { return normal_W.z() < 0.0 ? 0.5 : 2.0; }

Vector3d Ray(double azimuth_deg, double elevation_deg) {
  return sky::DirectionEnu(DegToRad(azimuth_deg), DegToRad(elevation_deg));
}

TEST(Occlusion, MeetsASquareWhereGeometrySays) {
  Scene scene;
  scene.meshes = {Ceiling({0.0, 0.0, 5.0}, 2.0)};
  const Occlusion occlusion(scene, White);
  const auto view = occlusion.From({0.0, 0.0, 1.0}, Vector3d::UnitZ(), DegToRad(60.0), 0);
  EXPECT_FALSE(view.empty());
  for (double off_deg = 0.0; off_deg < 60.0; off_deg += 0.5) {
    const auto hit = view.Look(Ray(90.0, 90.0 - off_deg));
    const double x = 4.0 * std::tan(DegToRad(off_deg));
    if (std::abs(x - 2.0) < 0.01) continue;
    ASSERT_EQ(hit.has_value(), x < 2.0) << off_deg;
    if (!hit) continue;
    EXPECT_NEAR(hit->distance_m, 4.0 / std::cos(DegToRad(off_deg)), 1e-6);
    EXPECT_EQ(hit->label, Label::kStructure);
    EXPECT_NEAR(hit->radiance, 0.4 * 0.5, 1e-6);  // lit from below, of a structure's reflectance
  }
}

// From above one sees the same triangles' other side, lit from above.
TEST(Occlusion, LightsTheSideThatIsSeen) {
  Scene scene;
  scene.meshes = {Ceiling({0.0, 0.0, 5.0}, 2.0)};
  const Occlusion occlusion(scene, White);
  const Vector3d down = -Vector3d::UnitZ();
  const auto hit = occlusion.From({0.0, 0.0, 9.0}, down, 0.1, 0).Look(down);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->radiance, 0.4 * 2.0, 1e-6);
}

TEST(Occlusion, KnowsWhenNothingIsInTheCone) {
  Scene scene;
  scene.meshes = {Ceiling({30.0, 0.0, 5.0}, 2.0)};
  const Occlusion occlusion(scene, White);
  EXPECT_TRUE(occlusion.From({0.0, 0.0, 1.0}, Vector3d::UnitZ(), DegToRad(20.0), 0).empty());
  EXPECT_FALSE(occlusion.From({0.0, 0.0, 1.0}, Vector3d::UnitZ(), DegToRad(85.0), 0).empty());
  const Scene nothing;
  EXPECT_TRUE(Occlusion(nothing, White).From({0, 0, 1}, Vector3d::UnitZ(), 1.5, 0).empty());
}

// A camera looks up at a square: it hides what is above it, and nothing below it, itself included.
// From above it is not drawn. Foliage has no gaps in pictures.
TEST(Occlusion, HidesFromCamerasWhatIsBehindAFront) {
  Scene scene;
  scene.meshes = {Ceiling({0.0, 0.0, 5.0}, 2.0, 0.3F)};
  const Occlusion occlusion(scene, White);
  const auto below = occlusion.Around({0.0, 0.0, 1.0}, 0);
  for (double x = 0.1; x < 8.0; x += 0.2) {
    EXPECT_EQ(below.Hides({x, 0.0, 9.0}), x < 4.0) << x;
    EXPECT_FALSE(below.Hides({x, 0.0, 4.9})) << x;
    EXPECT_FALSE(below.Hides({x, 0.0, 5.0})) << "its own points, " << x;
  }
  EXPECT_FALSE(below.Hides({0.0, 0.0, -9.0})) << "the other way";
  EXPECT_FALSE(occlusion.Around({0.0, 0.0, 9.0}, 0).Hides({0.0, 0.0, 1.0}));
}

TEST(Occlusion, AnActorHidesWhileItIsThere) {
  Actor actor{.name = "roof", .meshes = {Ceiling({0.0, 0.0, 5.0}, 2.0)}};
  nav::Pose T_WA;
  actor.path.push_back({0, T_WA});
  T_WA.p.x() = 10.0;
  actor.path.push_back({10 * nav::kNsPerSecond, T_WA});
  Scene scene;
  scene.actors = {actor};
  const Occlusion occlusion(scene, White);
  const auto hides = [&](double t_s) {
    return occlusion.Around({0.0, 0.0, 1.0}, nav::FromSeconds(t_s)).Hides({0.0, 0.0, 9.0});
  };
  EXPECT_TRUE(hides(0.0));
  EXPECT_TRUE(hides(1.9));
  EXPECT_FALSE(hides(2.1));
  EXPECT_FALSE(hides(11.0));
}

// 4000 rays through one layer: the share that meets leaves is `cover` within 3 sigma of the
// binomial, spots of 0.15 m taken as independent. Two layers leave the product.
TEST(Occlusion, LetsLightThroughFoliageAtSpotsThatStay) {
  Scene scene;
  scene.meshes = {Ceiling({0.0, 0.0, 5.0}, 40.0, 0.7F), Ceiling({0.0, 0.0, 7.0}, 40.0, 0.7F)};
  scene.meshes[1].vertices[0].p_W_m.x() = 0.0F;  // the second covers less: not used below
  Scene one;
  one.meshes = {scene.meshes[0]};
  const auto hidden = [](const Scene& leaves) {
    const Occlusion occlusion(leaves, White);
    std::vector<bool> found;
    for (int i = 0; i < 4000; ++i) {
      const Vector3d eye(1.0 + 0.31 * (i % 63), 1.0 + 0.31 * (i / 63), 1.0);
      found.push_back(
          occlusion.From(eye, Vector3d::UnitZ(), 0.0, 0).Look(Vector3d::UnitZ()).has_value());
    }
    return found;
  };
  const std::vector<bool> single = hidden(one);
  const auto share = [](const std::vector<bool>& found) {
    return static_cast<double>(std::count(found.begin(), found.end(), true)) / 4000.0;
  };
  const double sigma = std::sqrt(0.7 * 0.3 / 4000.0);
  EXPECT_NEAR(share(single), 0.7, 3.0 * sigma);
  EXPECT_EQ(single, hidden(one));
  EXPECT_NEAR(share(hidden(scene)), 1.0 - 0.3 * 0.3, 3.0 * std::sqrt(0.09 * 0.91 / 4000.0));
}

// Wide cones leave out rays above a skyline, narrow ones do not: they must agree on every ray.
TEST(Occlusion, FindsTheSameInWideConesAndNarrowOnes) {
  Scene scene;
  for (int i = 0; i < 60; ++i) {
    RandomStream::Sample random = RandomStream(1, 0, "test").At(static_cast<std::uint64_t>(i));
    const double x = 60.0 * (random.Uniform() - 0.5);
    const double y = 60.0 * (random.Uniform() - 0.5);
    scene.meshes.push_back(
        Ceiling({x, y, 1.0 + 12.0 * random.Uniform()}, 0.3 + 2.0 * random.Uniform()));
  }
  const Occlusion occlusion(scene, White);
  const Vector3d eye(0.3, -0.2, 1.5);
  const auto wide = occlusion.From(eye, Vector3d::UnitZ(), DegToRad(89.0), 0);
  int hits = 0;
  for (int azimuth = 0; azimuth < 360; azimuth += 2) {
    for (int elevation = 1; elevation < 90; ++elevation) {
      const Vector3d ray = Ray(azimuth + 0.3, elevation + 0.2);
      const auto expected = occlusion.From(eye, ray, 0.0, 0).Look(ray);
      const auto found = wide.Look(ray);
      ASSERT_EQ(found.has_value(), expected.has_value()) << azimuth << ", " << elevation;
      EXPECT_EQ(found ? found->distance_m : 0.0, expected ? expected->distance_m : 0.0);
      hits += found.has_value();
    }
  }
  EXPECT_GT(hits, 1000);
}

// A bus 12 m long passes, its middle 3 m to the north at t = 5 s: its near side is 1.725 m away and
// rises 1.35 m above the eye, straight up to there.
Scene WithBus() {
  Scene scene;
  SceneBuilder builder(32.0, false);
  const ActorTextures textures = AddActorTextures(1, builder);
  std::vector<ActorKey> path;
  for (int i = 0; i <= 10; ++i) {
    path.push_back({i * nav::kNsPerSecond,
                    {Eigen::Quaterniond::Identity(), Vector3d(10.0 * (i - 5), 3.0, 0.0)}});
  }
  scene.actors.push_back(MakeBus("bus", path, textures));
  return scene;
}

TEST(Occlusion, HidesBehindABusTheAzimuthsThatItTakesUp) {
  const Scene scene = WithBus();
  const Occlusion occlusion(scene, White);
  const auto hides = [&](double t_s, double azimuth_deg) {
    const auto view =
        occlusion.From({0.0, 0.0, 1.6}, Vector3d::UnitZ(), DegToRad(80.0), nav::FromSeconds(t_s));
    return view.Look(Ray(azimuth_deg, 20.0)).has_value();
  };
  // The ray rises 0.364 m a metre: it meets the side below 1.35 m when within 62 degrees of north.
  for (const double azimuth : {-55.0, -20.0, 0.0, 20.0, 55.0}) EXPECT_TRUE(hides(5.0, azimuth));
  for (const double azimuth : {-80.0, 80.0, 120.0, 180.0}) EXPECT_FALSE(hides(5.0, azimuth));
  EXPECT_FALSE(hides(3.0, 0.0));  // 20 m off
  EXPECT_FALSE(hides(11.0, 0.0));
}

// With a fixed exposure the picture changes where the bus is, and not a bit anywhere else.
TEST(Occlusion, ChangesTheSkyCamerasPictureWhereTheBusIsOnly) {
  const Scene scene = WithBus();
  const Occlusion occlusion(scene, White);
  const sky::WorldSky sky(sky::SkyOptions{}, Ray(230.0, 40.0), 1);
  PolarizationCameraOptions options;
  options.lens = "equidistant";
  options.focal_px = 100.0;
  options.width_px = 320;
  options.height_px = 320;
  options.auto_exposure = false;
  options.mount_error_sigma_deg = 0.0;
  Truth truth;  // faces east: image rows along east, columns along north or south
  truth.stamp = 5 * nav::kNsPerSecond;
  const PolarizationCamera open(options, sky, 1, 0);
  const PolarizationCamera beside(options, sky, 1, 0, &occlusion);
  const cv::Mat a = open.Take(truth, 0).mosaic;
  const cv::Mat b = beside.Take(truth, 0).mosaic;
  int differ_south = 0;
  int differ_north = 0;
  const auto calibration = NominalPolarizationCamera(options);
  for (int row = 0; row < a.rows; ++row) {
    for (int col = 0; col < a.cols; ++col) {
      if (a.at<std::uint16_t>(row, col) == b.at<std::uint16_t>(row, col)) continue;
      const Vector3d ray = nav::AxesOfPixel(calibration.lens, {double(col), double(row)}).ray_S;
      ++(ray.y() > 0.0 ? differ_north : differ_south);
    }
  }
  EXPECT_GT(differ_north, 5000);
  EXPECT_EQ(differ_south, 0);
  truth.stamp = 11 * nav::kNsPerSecond;  // it is gone
  EXPECT_EQ(cv::countNonZero(open.Take(truth, 0).mosaic != beside.Take(truth, 0).mosaic), 0);
}

}  // namespace
}  // namespace polnav::sim
