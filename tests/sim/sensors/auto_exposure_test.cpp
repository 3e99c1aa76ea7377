#include "sim/sensors/auto_exposure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "sim/sensors/stereo_camera.h"
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

}  // namespace
}  // namespace polnav::sim
