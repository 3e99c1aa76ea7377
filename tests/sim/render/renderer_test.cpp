#include "sim/render/renderer.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <memory>
#include <opencv2/core.hpp>
#include <thread>

#include "sim/render/gl_context.h"
#include "tests/sim/render/marker_scene.h"

namespace polnav::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kExposure = 0.3;
const PinholeView kView{.width_px = 400,
                        .height_px = 240,
                        .fx_px = 210.0,
                        .fy_px = 200.0,
                        .cx_px = 190.3,
                        .cy_px = 125.6};

// A camera that looks north-east, a little down and rolled: nothing cancels by symmetry.
nav::Pose TiltedCamera() {
  Eigen::Matrix3d level;  // columns: right, down, forward when looking north
  level << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(-0.7, Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(-0.1, Vector3d::UnitX()) *
                                Eigen::AngleAxisd(0.2, Vector3d::UnitY()));
  return {turn * Eigen::Quaterniond(level), {3.0, -2.0, 1.5}};
}

Vector2d Pixel(const Vector3d& p_C) {
  return {kView.fx_px * p_C.x() / p_C.z() + kView.cx_px,
          kView.fy_px * p_C.y() / p_C.z() + kView.cy_px};
}

// Quantization of 24 x 24 pixels to 8 bits moves the centre of a spot of sigma 3 by some 0.005
// pixels, llvmpipe's corners are rounded to 1/256 pixel; 0.05 is ten times that, and a tenth of the
// half pixel by which a wrong convention errs.
TEST(Renderer, ShowsAPointWhereThePinholeEquationSays) {
  const nav::Pose T_WC = TiltedCamera();
  const std::vector<Vector3d> points = {{0.02, -0.01, 3.0}, {-6.0, 2.5, 8.0},
                                        {9.1, 5.0, 12.0},   {30.0, -20.0, 45.0},
                                        {-1.2, -0.8, 1.9},  {70.0, 60.0, 150.0}};
  for (const Vector3d& p_C : points) {
    Scene scene = BlackRoom();
    AddSpot(T_WC, p_C, kView.fx_px, scene);
    Renderer renderer(scene, TestSky(), kView);
    cv::Mat image;
    renderer.Render({.T_WC = T_WC, .exposure = kExposure}, image);
    const Vector2d expected = Pixel(p_C);
    EXPECT_LT((Centroid(image, expected) - expected).norm(), 0.05) << p_C.transpose();
  }
}

TEST(Renderer, LetsTheNearerSurfaceHideTheFartherInWhateverOrderTheyCome) {
  const nav::Pose T_WC = TiltedCamera();
  for (const double wall_z : {4.9, 5.1}) {
    for (const bool wall_first : {true, false}) {
      Scene scene = BlackRoom();
      const auto wall = [&] {
        const auto at = [&](double x, double y) { return Vector3d(T_WC * Vector3d(x, y, wall_z)); };
        AddQuad({at(-2, 2), at(2, 2), at(2, -2), at(-2, -2)}, 0, scene);
      };
      if (wall_first) wall();
      AddSpot(T_WC, {0.0, 0.0, 5.0}, kView.fx_px, scene);
      if (!wall_first) wall();
      Renderer renderer(scene, TestSky(), kView);
      cv::Mat image;
      renderer.Render({.T_WC = T_WC, .exposure = kExposure}, image);
      const bool is_seen = image.at<std::uint8_t>(126, 190) > 50;
      EXPECT_EQ(is_seen, wall_z > 5.0);
    }
  }
}

TEST(Renderer, DoublesTheGreyWithTheExposureUntilItSaturates) {
  const nav::Pose T_WC = TiltedCamera();
  Scene scene = BlackRoom();
  const auto at = [&](double x, double y) { return Vector3d(T_WC * Vector3d(x, y, 5.0)); };
  AddQuad({at(-2, 2), at(2, 2), at(2, -2), at(-2, -2)}, 2, scene);
  Renderer renderer(scene, TestSky(), kView);
  cv::Mat once;
  cv::Mat twice;
  cv::Mat bright;
  renderer.Render({.T_WC = T_WC, .exposure = 0.05}, once);
  renderer.Render({.T_WC = T_WC, .exposure = 0.10}, twice);
  renderer.Render({.T_WC = T_WC, .exposure = 50.0}, bright);
  const int grey = once.at<std::uint8_t>(126, 190);
  EXPECT_GT(grey, 5);
  EXPECT_NEAR(twice.at<std::uint8_t>(126, 190), 2 * grey, 1);  // each rounded to half a grey
  EXPECT_EQ(bright.at<std::uint8_t>(126, 190), 255);
}

TEST(Renderer, LeavesUnneededPixelsBlackAndTheOthersAsTheyWere) {
  const Scene empty;  // only sky
  const nav::Pose T_WC = TiltedCamera();
  cv::Mat whole;
  cv::Mat masked;
  Renderer(empty, TestSky(), kView).Render({.T_WC = T_WC, .exposure = kExposure}, whole);
  const std::vector<Vector2d> corner = {{-0.5, -0.5}, {99.5, -0.5}, {-0.5, 99.5}};
  Renderer(empty, TestSky(), kView, corner).Render({.T_WC = T_WC, .exposure = kExposure}, masked);
  EXPECT_EQ(masked.at<std::uint8_t>(20, 20), 0);
  EXPECT_GT(whole.at<std::uint8_t>(20, 20), 0);
  const cv::Rect rest(100, 0, kView.width_px - 100, kView.height_px);
  EXPECT_EQ(cv::norm(whole(rest), masked(rest), cv::NORM_INF), 0.0);
}

TEST(Renderer, GivesTheSameBytesInAnyThreadAndAgain) {
  const nav::Pose T_WC = TiltedCamera();
  Scene scene = BlackRoom();
  for (int i = 0; i < 8; ++i) AddSpot(T_WC, {i - 4.0, 0.3 * i - 1.0, 6.0 + i}, 210.0, scene);
  std::array<cv::Mat, 2> first;
  std::array<cv::Mat, 2> again;
  const auto work = [&](std::size_t i) {
    Renderer renderer(scene, TestSky(), kView);
    cv::Mat other;
    renderer.Render({.T_WC = T_WC, .exposure = kExposure}, first[i]);
    for (int k = 0; k < 5; ++k) {
      renderer.Render({.T_WC = {T_WC.q, {0.1 * k, 0.0, 1.0}},
                       .stamp = k * nav::kNsPerSecond,
                       .exposure = kExposure,
                       .visibility_m = 10.0 + k},
                      other);
    }
    renderer.Render({.T_WC = T_WC, .exposure = kExposure}, again[i]);
  };
  std::thread a(work, 0);
  std::thread b(work, 1);
  a.join();
  b.join();
  EXPECT_GT(cv::norm(first[0], cv::NORM_INF), 100.0);
  EXPECT_EQ(cv::norm(first[0], first[1], cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(first[0], again[0], cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(first[1], again[1], cv::NORM_INF), 0.0);
}

// See gl_context.h, and renderer_threads_test for what happens without.
TEST(Renderer, WaitsForItsTurn) {
  auto others_turn = std::make_unique<GlTurn>();
  cv::Mat image;
  std::future<void> drawn = std::async(std::launch::async, [&] {
    Renderer(BlackRoom(), TestSky(), kView).Render({.exposure = kExposure}, image);
  });
  // Several times what it takes alone; on a slow machine this proves less, but never fails wrongly.
  EXPECT_EQ(drawn.wait_for(std::chrono::milliseconds(300)), std::future_status::timeout);
  others_turn.reset();
  drawn.get();
  EXPECT_FALSE(image.empty());
}

}  // namespace
}  // namespace polnav::sim
