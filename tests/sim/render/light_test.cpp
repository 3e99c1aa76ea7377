// Sun, shade, fog and cloud in the renderer's pictures. A camera looks straight down on white
// ground from 30 m up: pixels are places.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "sim/render/lighting.h"
#include "sim/render/renderer.h"
#include "tests/sim/render/marker_scene.h"

namespace polnav::sim {
namespace {

using Eigen::Vector3d;

constexpr double kHeight_m = 30.0;
constexpr double kExposure = 0.25;
const PinholeView kView{.width_px = 401,
                        .height_px = 301,
                        .fx_px = 300.0,
                        .fy_px = 300.0,
                        .cx_px = 200.0,
                        .cy_px = 150.0};
// 30 degrees high in the east: shadows fall to the west, sqrt(3) times as long as things are high.
const Vector3d kSun_W(std::sqrt(0.75), 0.0, 0.5);

sky::WorldSky Sky(const std::string& clouds, double veil = 0.0) {
  sky::SkyOptions options;
  options.clouds = clouds;
  if (clouds == "clear") options.thin_cloud_cover = veil;
  return {options, kSun_W, 1};
}

nav::Pose LookingDown() {
  return {Eigen::Quaterniond(Vector3d(1.0, -1.0, -1.0).asDiagonal().toDenseMatrix()),
          {0.0, 0.0, kHeight_m}};
}

// Upright sides and a roof, 4 m high and 2 m square, about the origin; texture 0 is black.
std::vector<Mesh> Block(Label label) {
  Scene scene;
  const auto at = [](double x, double y, double z) { return Vector3d(x, y, z); };
  AddQuad({at(-1, -1, 4), at(1, -1, 4), at(1, 1, 4), at(-1, 1, 4)}, 0, scene);
  AddQuad({at(1, -1, 0), at(1, 1, 0), at(1, 1, 4), at(1, -1, 4)}, 0, scene);
  AddQuad({at(-1, 1, 0), at(-1, -1, 0), at(-1, -1, 4), at(-1, 1, 4)}, 0, scene);
  for (Mesh& mesh : scene.meshes) mesh.label = label;
  return scene.meshes;
}

Scene WhiteGround() {
  Scene scene = BlackRoom();
  scene.meshes.clear();
  AddQuad({Vector3d(-30, -30, 0), Vector3d(30, -30, 0), Vector3d(30, 30, 0), Vector3d(-30, 30, 0)},
          2, scene);
  return scene;
}

cv::Mat Picture(const Scene& scene, const sky::WorldSky& sky, double t_s = 0.0,
                double visibility_m = std::numeric_limits<double>::infinity()) {
  Renderer renderer(scene, sky, kView);
  cv::Mat image;
  renderer.Render({.T_WC = LookingDown(),
                   .stamp = nav::FromSeconds(t_s),
                   .exposure = kExposure,
                   .visibility_m = visibility_m},
                  image);
  return image;
}

// Of the ground there.
double Grey(const cv::Mat& image, double east_m, double north_m) {
  const double scale = kView.fx_px / kHeight_m;
  return image.at<std::uint8_t>(static_cast<int>(std::lround(kView.cy_px - scale * north_m)),
                                static_cast<int>(std::lround(kView.cx_px + scale * east_m)));
}

double Expected(double radiance) { return 255.0 * kExposure * radiance; }

// The shadow of 4 m ends 4 sqrt(3) = 6.93 m west of the western wall's top, at -7.93 m. A texel of
// 5 cm and the offset against acne leave 0.3 m to either side.
TEST(SunShadow, IsAsLongAsTheSunIsLow) {
  Scene scene = WhiteGround();
  for (const Mesh& mesh : Block(Label::kBuilding)) scene.meshes.push_back(mesh);
  const sky::WorldSky sky = Sky("clear");
  const cv::Mat image = Picture(scene, sky);
  const Lighting lighting(sky);
  const double dark = Expected(lighting.FromSky(Vector3d::UnitZ()));
  const double lit = Expected(lighting.OfWhite(Vector3d::UnitZ()));
  ASSERT_LT(lit, 250.0);
  ASSERT_GT(lit, 1.3 * dark);
  for (const double east_m : {-7.6, -5.0, -2.0}) EXPECT_NEAR(Grey(image, east_m, 0.0), dark, 2.0);
  for (const double east_m : {-8.3, -12.0, 3.0}) EXPECT_NEAR(Grey(image, east_m, 0.0), lit, 2.0);
  EXPECT_NEAR(Grey(image, -5.0, 0.8), dark, 2.0);
  EXPECT_NEAR(Grey(image, -5.0, 1.3), lit, 2.0);
}

TEST(SunShadow, FadesWhereACloudStandsBeforeTheSun) {
  Scene scene = WhiteGround();
  for (const Mesh& mesh : Block(Label::kBuilding)) scene.meshes.push_back(mesh);
  const cv::Mat image = Picture(scene, Sky("overcast"));
  EXPECT_NEAR(Grey(image, -5.0, 0.0), Grey(image, -12.0, 0.0), 1.0);
}

// 5 m/s to the north: at 2 s it is 10 m north, its shadow beside it.
TEST(Actor, IsWhereItsPathSaysAndSoIsItsShadow) {
  Scene scene = WhiteGround();
  Actor actor{.name = "block", .meshes = Block(Label::kVehicle)};
  for (int k = 0; k < 4; ++k) {
    actor.path.push_back(
        {k * nav::kNsPerSecond, {Eigen::Quaterniond::Identity(), {0, 5.0 * k, 0}}});
  }
  scene.actors.push_back(actor);
  const sky::WorldSky sky = Sky("clear");
  const Lighting lighting(sky);
  const double dark = Expected(lighting.FromSky(Vector3d::UnitZ()));
  const double lit = Expected(lighting.OfWhite(Vector3d::UnitZ()));
  const cv::Mat at_2s = Picture(scene, sky, 2.0);
  EXPECT_EQ(Grey(at_2s, 0.0, 10.5), 0.0) << "its roof is black";
  EXPECT_NEAR(Grey(at_2s, -5.0, 10.0), dark, 2.0);
  EXPECT_NEAR(Grey(at_2s, -5.0, 5.0), lit, 2.0);
  EXPECT_NEAR(Grey(at_2s, 0.0, 5.0), lit, 2.0);
  const cv::Mat gone = Picture(scene, sky, 3.5);
  EXPECT_NEAR(Grey(gone, 0.0, 13.0), lit, 2.0);
}

// Black ground 30 m below shows the airlight's share 1 - exp(-3.912 * 30 / V) [Koschmieder1924].
TEST(Fog, HidesByKoschmiedersLaw) {
  Scene scene = WhiteGround();
  scene.meshes.front().texture = 0;
  const sky::WorldSky sky = Sky("clear");
  const auto share = [](double visibility_m) {
    return 1.0 - std::exp(-3.912 * 30.0 / visibility_m);
  };
  const double dense = Grey(Picture(scene, sky, 0.0, 40.0), 0.0, 0.0);
  const double thin = Grey(Picture(scene, sky, 0.0, 400.0), 0.0, 0.0);
  EXPECT_EQ(Grey(Picture(scene, sky), 0.0, 0.0), 0.0);
  ASSERT_LT(dense, 250.0);
  // The airlight itself: a layer of 50 m throws back 0.75 (1 - 0.85) of its optical depth.
  const double airlight = Expected(Lighting(sky).OfWhite(Vector3d::UnitZ()));
  const auto glow = [&](double visibility_m) {
    return airlight / (1.0 + 0.1125 * 3.912 * 50.0 / visibility_m);
  };
  EXPECT_NEAR(dense, glow(40.0) * share(40.0), 1.0);
  EXPECT_NEAR(thin, glow(400.0) * share(400.0), 1.0);
}

// Between vertices 4.5 degrees apart radiance is interpolated: clouds' edges are off by more than
// the mean error that is allowed here, which clouds half a minute older exceed.
TEST(Clouds, InThePictureAreThoseOfTheSky) {
  sky::SkyOptions options;
  options.clouds = "many_clouds";
  options.wind_m_s = 20.0;
  const sky::WorldSky sky(options, kSun_W, 3);
  Scene scene = WhiteGround();
  Renderer renderer(scene, sky, kView);
  cv::Mat image;
  const nav::Pose up{Eigen::Quaterniond::Identity(), {0.0, 0.0, 1.0}};
  constexpr double kDim = 0.1;
  renderer.Render({.T_WC = up, .stamp = nav::FromSeconds(30.0), .exposure = kDim}, image);
  const auto mean_error = [&](double t_s) {
    double sum = 0.0;
    int count = 0;
    for (int row = 10; row < image.rows; row += 20) {
      for (int col = 10; col < image.cols; col += 20, ++count) {
        const Vector3d ray =
            Vector3d((col - kView.cx_px) / kView.fx_px, (row - kView.cy_px) / kView.fy_px, 1.0)
                .normalized();
        const double radiance = sky.Look(ray, Vector3d::Zero(), t_s).radiance;
        sum += std::abs(image.at<std::uint8_t>(row, col) / (255.0 * kDim * radiance) - 1.0);
      }
    }
    return sum / count;
  };
  EXPECT_LT(mean_error(30.0), 0.15);
  EXPECT_GT(mean_error(0.0), 1.5 * mean_error(30.0));
}

}  // namespace
}  // namespace polnav::sim
