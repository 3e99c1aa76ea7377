#include "sim/sensors/auto_exposure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "sim/measurement_stream.h"
#include "tests/sim/render/marker_scene.h"

namespace polnav::sim {
namespace {

const nav::Pose kBody{nav::LevelAttitude(2.0), {1.0, 2.0, 0.4}};

// White walls all around.
Scene WhiteRoom() {
  Scene scene = BlackRoom();
  for (Mesh& mesh : scene.meshes) mesh.texture = 2;
  return scene;
}

// Driving into a quarter of the light: the logarithm of the error falls by e in a time constant, of
// which one frame passes before the first look.
TEST(AutoExposure, RecoversTheMeanGreyWithinItsTimeConstant) {
  StereoCameraOptions options;
  options.auto_exposure = true;
  options.auto_exposure_time_constant_s = 0.5;
  options.full_well_e = 1e6;
  const nav::StereoCalibration truth = NominalStereo(options);
  const Scene scene = WhiteRoom();
  AutoExposure automatic(scene, TestSky(), truth.left, options);
  StereoCamera camera(scene, TestSky(), truth, options, 1, 1);
  const auto mean_at = [&](int frame, double light_share) {
    FrameRequest request{.stamp = nav::FromSeconds(0.1 * frame),
                         .T_WB = kBody,
                         .conditions = {.light_share = light_share}};
    request.exposure = automatic.Next(request);
    return cv::mean(camera.Capture(request).left)[0];
  };
  // The metered picture is 48 pixels wide, and both are rounded to greys.
  constexpr double kTolerance = 0.02;
  const double target = options.target_mean;
  for (int frame = 0; frame < 5; ++frame) {
    EXPECT_NEAR(mean_at(frame, 1.0), target, kTolerance * target);
  }
  for (int frame = 5; frame < 40; ++frame) {
    const double mean = mean_at(frame, 0.25);
    const double since_s = 0.1 * (frame - 5);
    const double log_error = std::log(0.25) * std::exp(-since_s / 0.5);
    EXPECT_NEAR(mean, target * std::exp(log_error), kTolerance * target) << since_s;
  }
}

SimulatorOptions SmallOptions(bool auto_exposure) {
  SimulatorOptions options;
  options.world.plaza = {
      .tree_count = 3, .lamp_count = 3, .parked_car_count = 2, .furniture_count = 3};
  options.sensors.stereo = StereoCameraOptions{
      .width_px = 160, .height_px = 96, .focal_px = 90.0, .auto_exposure = auto_exposure};
  return options;
}

std::vector<cv::Mat> LeftPictures(const SimulatorOptions& options, int render_threads) {
  std::vector<cv::Mat> pictures;
  MeasurementStream stream(options, {1, 0}, nav::FromSeconds(1.0), render_threads);
  while (const auto item = stream.Next()) {
    const auto* measurement = std::get_if<nav::Measurement>(&*item);
    if (measurement == nullptr) continue;
    if (const auto* pair = std::get_if<nav::StereoImages>(measurement)) {
      pictures.push_back(pair->left);
    }
  }
  return pictures;
}

// The exposure of a picture depends on those before it, whoever takes them.
TEST(AutoExposure, GivesTheSameBytesWithOneAndTwoRenderThreads) {
  const std::vector<cv::Mat> one = LeftPictures(SmallOptions(true), 1);
  const std::vector<cv::Mat> two = LeftPictures(SmallOptions(true), 2);
  ASSERT_EQ(one.size(), 11U);
  ASSERT_EQ(two.size(), 11U);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(cv::norm(one[i], two[i], cv::NORM_INF), 0.0) << i;
  }
  const std::vector<cv::Mat> fixed = LeftPictures(SmallOptions(false), 1);
  EXPECT_GT(cv::norm(one[5], fixed[5], cv::NORM_INF), 0.0) << "the exposure is its own";
}

}  // namespace
}  // namespace polnav::sim
