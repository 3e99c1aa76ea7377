#include "sim/world/plaza.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <stdexcept>

#include "sim/sensors/lens.h"
#include "sim/sensors/stereo_camera.h"
#include "sky/sun.h"

namespace polnav::sim {
namespace {

using Eigen::Vector3d;

class PlazaTest : public testing::Test {
 protected:
  // Building takes a second: the suite runs in one process (CMakeLists.txt) and shares this one.
  [[nodiscard]] const Scene& Shared() const {
    static const Scene scene = Build(5);
    return scene;
  }
  [[nodiscard]] Scene Build(std::uint64_t seed, const PlazaOptions& options = {}) const {
    return BuildPlaza(options, track, terrain, seed);
  }
  // On the centre line, turned away from it.
  [[nodiscard]] nav::Pose Body(double s_m, double turn_rad) const {
    const Track::Point point = track.At(s_m);
    const double yaw = std::atan2(point.tangent.y(), point.tangent.x()) + turn_rad;
    return {Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Vector3d::UnitZ())),
            {point.p_m.x(), point.p_m.y(), terrain.Height(point.p_m.x(), point.p_m.y()) + 0.3}};
  }

  Track track{TrackOptions{}};
  Terrain terrain{TerrainOptions{}, track, 1};
  sky::WorldSky sky{sky::SkyOptions{}, sky::DirectionEnu(nav::DegToRad(230.0), nav::DegToRad(16.5)),
                    1};
};

bool Same(const Scene& a, const Scene& b) {
  if (a.meshes.size() != b.meshes.size() || a.textures.size() != b.textures.size()) return false;
  for (std::size_t i = 0; i < a.meshes.size(); ++i) {
    if (a.meshes[i].indices != b.meshes[i].indices) return false;
    for (std::size_t k = 0; k < a.meshes[i].vertices.size(); ++k) {
      const Vertex& u = a.meshes[i].vertices[k];
      const Vertex& v = b.meshes[i].vertices[k];
      if (u.p_W_m != v.p_W_m || u.uv != v.uv || u.shade != v.shade) return false;
    }
  }
  for (std::size_t i = 0; i < a.textures.size(); ++i) {
    if (cv::norm(a.textures[i], b.textures[i], cv::NORM_INF) != 0.0) return false;
  }
  return true;
}

TEST_F(PlazaTest, IsFixedByItsSeed) {
  EXPECT_TRUE(Same(Shared(), Build(5)));
  EXPECT_FALSE(Same(Shared(), Build(6)));
}

// The zenith over the road must be sky: nothing but ground there, up to the kerbs.
TEST_F(PlazaTest, HasNothingStandingOnOrReachingOverTheRoad) {
  std::size_t triangles = 0;
  for (const Mesh& mesh : Shared().meshes) {
    triangles += mesh.indices.size() / 3;
    ASSERT_LT(*std::max_element(mesh.indices.begin(), mesh.indices.end()), mesh.vertices.size());
    for (const Vertex& v : mesh.vertices) {
      const Eigen::Vector2d p = v.p_W_m.head<2>().cast<double>();
      if (v.p_W_m.z() < terrain.Height(p.x(), p.y()) + 0.3) continue;
      EXPECT_GT(track.RadialDistance(p), 0.5 * track.road_width_m());
    }
  }
  EXPECT_GT(triangles, 20000U);
  EXPECT_LT(triangles, 60000U);
}

// Corners in every part of the picture that is not sky, and greys in the middle of the range.
TEST_F(PlazaTest, OffersCornersEverywhereAndSaneBrightness) {
  const StereoCameraOptions options;
  StereoCamera camera(Shared(), sky, NominalStereo(options), options, 1, 1);
  for (const double s : {0.0, 120.0, 250.0}) {
    const cv::Mat image = camera.Capture(Body(s, 0.0), 0, 0).left;
    std::vector<cv::Point2f> corners;
    cv::goodFeaturesToTrack(image, corners, 1500, 0.01, 8);
    EXPECT_GT(corners.size(), 300U);
    int lower_left = 0;
    int lower_right = 0;
    for (const cv::Point2f& c : corners) {
      if (c.y > 220.0F) ++(c.x < 336.0F ? lower_left : lower_right);
    }
    EXPECT_GT(lower_left, 20);
    EXPECT_GT(lower_right, 20);
    EXPECT_GT(cv::mean(image)[0], 60.0);
    EXPECT_LT(cv::mean(image)[0], 170.0);
    EXPECT_LT(cv::countNonZero(image == 255), 0.25 * static_cast<double>(image.total()));
  }
}

// Tracked from frame to frame, static points must obey the epipolar geometry of the true motion:
// what is left is the tracker's noise and the renderer's. 0.6 m and 0.57 degrees a frame is the
// default drive; 0.2 px is what an estimator counts on.
TEST_F(PlazaTest, TracksFromFrameToFrameWithinAFifthOfAPixel) {
  const StereoCameraOptions options;
  const nav::StereoCalibration truth = NominalStereo(options);
  StereoCamera camera(Shared(), sky, truth, options, 1, 1);
  const nav::Pose T_WC1 = Body(60.0, 0.0) * truth.left.T_BC;
  const nav::Pose T_WC2 = Body(60.6, 0.0) * truth.left.T_BC;
  const cv::Mat before = camera.Capture(Body(60.0, 0.0), 0, 0).left;
  const cv::Mat after = camera.Capture(Body(60.6, 0.0), 0, 1).left;
  std::vector<cv::Point2f> from;
  cv::goodFeaturesToTrack(before, from, 600, 0.01, 12);
  std::vector<cv::Point2f> to;
  std::vector<std::uint8_t> found;
  cv::calcOpticalFlowPyrLK(before, after, from, to, found, cv::noArray(), {21, 21}, 3);
  const nav::Pose T_C2C1 = T_WC2.Inverse() * T_WC1;
  std::vector<double> off_px;
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (found[i] == 0) continue;
    const Vector3d ray1 = RayOfPixel(truth.left, from[i].x, from[i].y).homogeneous();
    const Vector3d ray2 = RayOfPixel(truth.left, to[i].x, to[i].y).homogeneous();
    const Vector3d line = T_C2C1.p.cross(T_C2C1.q * ray1);
    off_px.push_back(truth.left.fx_px * std::abs(ray2.dot(line)) / line.head<2>().norm());
  }
  ASSERT_GT(off_px.size(), 250U);
  std::nth_element(off_px.begin(), off_px.begin() + off_px.size() / 2, off_px.end());
  EXPECT_LT(off_px[off_px.size() / 2], 0.2);
}

TEST_F(PlazaTest, RefusesALoopWithNoRoomForAPark) {
  const Track short_loop({.length_m = 40.0, .noncircularity = 0.0, .road_width_m = 4.0});
  EXPECT_THROW(static_cast<void>(BuildPlaza({}, short_loop, terrain, 1)), std::invalid_argument);
}

TEST_F(PlazaTest, IsPlainWithoutContrast) {
  PlazaOptions plain;
  plain.texture_contrast = 0.0;
  const Scene scene = Build(5, plain);
  for (const cv::Mat& texture : scene.textures) {
    double low = 0.0;
    double high = 0.0;
    cv::minMaxLoc(texture, &low, &high);
    EXPECT_EQ(low, high);
  }
  for (const Mesh& mesh : scene.meshes) {
    for (const Vertex& v : mesh.vertices) ASSERT_EQ(v.shade, 1.0F);
  }
}

}  // namespace
}  // namespace polnav::sim
