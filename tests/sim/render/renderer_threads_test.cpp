#include <gtest/gtest.h>

#include <array>
#include <opencv2/core.hpp>
#include <thread>
#include <vector>

#include "sim/render/renderer.h"
#include "tests/sim/render/marker_scene.h"

namespace polnav::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr PinholeView kView{
    .width_px = 32, .height_px = 32, .fx_px = 16.0, .fy_px = 16.0, .cx_px = 15.5, .cy_px = 15.5};

// Spots all over the picture of a level camera that looks north, a texture each.
Scene ManyTextures() {
  constexpr int kSide = 16;
  constexpr double kSpacing_m = 0.6;
  Scene scene = BlackRoom();
  for (int i = 0; i < kSide * kSide; ++i) {
    const double x = kSpacing_m * (i / kSide - 0.5 * (kSide - 1));
    const double z = kSpacing_m * (i % kSide - 0.5 * (kSide - 1));
    AddQuad({Vector3d(x, 5.0, z), Vector3d(x + 0.5, 5.0, z), Vector3d(x + 0.5, 5.0, z + 0.5),
             Vector3d(x, 5.0, z + 0.5)},
            static_cast<int>(scene.textures.size()), scene);
    scene.textures.emplace_back(4, 4, CV_8UC1, cv::Scalar(100 + i % 100));
  }
  return scene;
}

// One upon another in a corner of the picture.
std::vector<Vector2d> ManyTriangles() {
  std::vector<Vector2d> corners;
  for (int i = 0; i < 1000; ++i) {
    const double row = 0.002 * i;
    corners.insert(corners.end(), {{0.0, row}, {2.0, row}, {0.0, row + 2.0}});
  }
  return corners;
}

cv::Mat LastOfManyPictures(const Scene& scene) {
  Eigen::Matrix3d level;  // columns: right, down, forward when looking north
  level << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  Renderer renderer(scene, TestSky(), kView, ManyTriangles());
  cv::Mat image;
  for (int i = 0; i <= 300; ++i) {
    // Another part of the wall each time: what is noted down lies elsewhere in memory.
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.37 * (i % 5), Vector3d::UnitZ()));
    renderer.Render({.T_WC = {turn * Eigen::Quaterniond(level), {0.0, 0.0, 0.0}}, .exposure = 0.3},
                    image);
  }
  return image;
}

// Tiny pictures of many textures behind many triangles: the threads spend their time where llvmpipe
// notes down what a picture needs and looks up what others have noted. Without turns (gl_context.h)
// every other run of this crashed in there, on two cores.
TEST(RendererThreads, DrawManyTexturesWithoutReadingEachOthersNotes) {
  const Scene scene = ManyTextures();
  std::array<cv::Mat, 8> last;
  {
    std::vector<std::jthread> threads;
    for (cv::Mat& image : last) threads.emplace_back([&] { image = LastOfManyPictures(scene); });
  }
  EXPECT_GT(cv::norm(last[0], cv::NORM_INF), 50.0);
  for (const cv::Mat& image : last) EXPECT_EQ(cv::norm(last[0], image, cv::NORM_INF), 0.0);
}

}  // namespace
}  // namespace polnav::sim
