#include "sim/sensors/shutter.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "sim/sensors/stereo_camera.h"
#include "tests/sim/render/marker_scene.h"

namespace polnav::sim {
namespace {

using Eigen::Vector3d;

const nav::Pose kBody{nav::LevelAttitude(2.0), {1.0, 2.0, 0.4}};

// No distortion, level, almost no noise.
StereoCameraOptions PlainCamera() {
  StereoCameraOptions options;
  options.k1 = options.k2 = options.p1 = options.p2 = 0.0;
  options.pitch_down_deg = 0.0;
  options.position_m = Vector3d::Zero();  // it turns about itself
  options.exposure = 0.3;
  options.full_well_e = 1e6;
  options.read_noise_e = 0.0;
  return options;
}

// A bright pole, a Gaussian of sigma 4 px across, 20 m straight ahead of the left camera and higher
// than the picture. A sharp edge would jump from one pixel of the renderer to the next.
Scene Pole(const nav::StereoCalibration& camera) {
  Scene scene = BlackRoom();
  cv::Mat ridge(64, 64, CV_8UC1);
  scene.textures[1].row(32).copyTo(ridge.row(0));
  for (int row = 1; row < ridge.rows; ++row) ridge.row(0).copyTo(ridge.row(row));
  scene.textures.push_back(ridge);
  constexpr double kDepth_m = 20.0;
  const double half = 16.0 * kDepth_m / camera.left.fx_px;
  const nav::Pose T_WC = kBody * camera.left.T_BC;
  const auto at = [&](double x, double y) { return Vector3d(T_WC * Vector3d(x, y, kDepth_m)); };
  AddQuad({at(-half, 30.0), at(half, 30.0), at(half, -30.0), at(-half, -30.0)}, 3, scene);
  return scene;
}

// Where the light of a row is, and how far it is spread: mean and variance in columns.
struct Spread {
  double mean = 0.0;
  double variance = 0.0;
};

Spread OfRow(const cv::Mat& image, int row) {
  double sum = 0.0;
  double first = 0.0;
  double second = 0.0;
  for (int col = 0; col < image.cols; ++col) {
    const double grey = image.at<std::uint8_t>(row, col);
    if (grey < 2.0) continue;
    sum += grey;
    first += grey * col;
    second += grey * col * col;
  }
  const double mean = first / sum;
  return {mean, second / sum - mean * mean};
}

cv::Mat PictureOfPole(const StereoCameraOptions& options, const Vector3d& w_WB_B) {
  const nav::StereoCalibration camera = NominalStereo(options);
  return StereoCamera(Pole(camera), TestSky(), camera, options, 1, 1)
      .Capture({.T_WB = kBody, .w_WB_B_rad_s = w_WB_B})
      .left;
}

// To the left the camera turns, to the right the world goes: f w per second at the picture's
// centre. A row is a mean of sub-frames half a pixel apart, rounded to greys: 0.05 px.
TEST(Shutter, APoleLeansByTheYawRateTimesTheReadoutTime) {
  StereoCameraOptions options = PlainCamera();
  options.rolling_shutter_s = 0.03;
  const Vector3d w(0.0, 0.0, 1.5);
  const cv::Mat image = PictureOfPole(options, w);
  const double shift_px = options.focal_px * w.z() * options.rolling_shutter_s;
  const int last = options.height_px - 1;
  for (const int row : {5, 100, 188, 280, last - 5}) {
    // Away from the axis the tangent grows: tan of the angle turned by then.
    const double t_s = options.rolling_shutter_s * (static_cast<double>(row) / last - 0.5);
    const double expected = 0.5 * (options.width_px - 1) + options.focal_px * std::tan(w.z() * t_s);
    EXPECT_NEAR(OfRow(image, row).mean, expected, 0.05) << row;
  }
  const double lean =
      std::atan((OfRow(image, last - 5).mean - OfRow(image, 5).mean) / (last - 10.0));
  EXPECT_NEAR(lean, std::atan(shift_px / last), 0.001);
  EXPECT_GT(nav::RadToDeg(lean), 2.0);
}

// A box of the blur's length folded with the pole: their variances add, L^2 / 12. Clipping dim
// greys at the ends and rounding cost less than 2 % of it.
TEST(Shutter, BlurIsAsLongAsRateTimesExposureTimesFocalLength) {
  StereoCameraOptions options = PlainCamera();
  const Vector3d w(0.0, 0.0, 1.5);
  const double sharp = OfRow(PictureOfPole(options, w), 188).variance;
  for (const double exposure_s : {0.01, 0.03, 0.06}) {
    options.exposure_time_s = exposure_s;
    const Spread blurred = OfRow(PictureOfPole(options, w), 188);
    const double length = std::sqrt(12.0 * (blurred.variance - sharp));
    EXPECT_NEAR(length, options.focal_px * w.z() * exposure_s, 0.02 * length + 0.1);
    EXPECT_NEAR(blurred.mean, 0.5 * (options.width_px - 1), 0.05) << "the stamp is the middle";
  }
}

TEST(Shutter, BlursForwardMotionByTheVelocity) {
  StereoCameraOptions options = PlainCamera();
  options.exposure_time_s = 0.02;
  const nav::StereoCalibration camera = NominalStereo(options);
  const double sharp = OfRow(PictureOfPole(PlainCamera(), Vector3d::Zero()), 188).variance;
  StereoCamera stereo(Pole(camera), TestSky(), camera, options, 1, 1);
  const Vector3d to_the_left(0.0, 15.0, 0.0);
  const cv::Mat image = stereo.Capture({.T_WB = kBody, .v_WB_m_s = kBody.q * to_the_left}).left;
  const double length = std::sqrt(12.0 * (OfRow(image, 188).variance - sharp));
  const double expected = options.focal_px * 15.0 / 20.0 * options.exposure_time_s;
  EXPECT_NEAR(length, expected, 0.02 * expected + 0.1);
}

// One millisecond between the eyes would shift the pole by 0.26 px in one of them at 15 m/s.
TEST(Shutter, BothEyesLookAtTheSameInstantsInMotion) {
  StereoCameraOptions options = PlainCamera();
  options.exposure_time_s = 0.01;
  options.rolling_shutter_s = 0.02;
  const nav::StereoCalibration camera = NominalStereo(options);
  StereoCamera stereo(Pole(camera), TestSky(), camera, options, 1, 1);
  const Vector3d to_the_left(0.0, 15.0, 0.0);
  const nav::StereoImages pair =
      stereo.Capture({.stamp = 77, .T_WB = kBody, .v_WB_m_s = kBody.q * to_the_left});
  EXPECT_EQ(pair.stamp, 77);
  for (const int row : {20, 188, 350}) {
    const double disparity = OfRow(pair.left, row).mean - OfRow(pair.right, row).mean;
    EXPECT_NEAR(disparity, options.focal_px * options.baseline_m / 20.0, 0.05) << row;
  }
}

TEST(Shutter, SharesOfARowSumToOneAndAreOpenForItsExposureOnly) {
  const Shutter shutter(0.004, 0.02, 350.0);
  const auto sub_frames = shutter.SubFramesOf({.stamp = 1000000000});
  const int count = static_cast<int>(sub_frames.size());
  EXPECT_EQ(count, 24);  // a millisecond each
  for (const int row : {0, 17, 188, 375}) {
    const double middle_s = 1.0 + 0.02 * (row / 375.0 - 0.5);
    double sum = 0.0;
    double mean_s = 0.0;
    for (int i = 0; i < count; ++i) {
      const double share = shutter.Share(row, 376, i, count);
      const double at_s = nav::ToSeconds(sub_frames[static_cast<std::size_t>(i)].stamp);
      sum += share;
      mean_s += share * at_s;
      if (std::abs(at_s - middle_s) > 0.0026) {
        EXPECT_EQ(share, 0.0);
      }
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    // A sub-frame counts at its middle though a row may be open in a part of it only.
    EXPECT_NEAR(mean_s, middle_s, 0.0001);
  }
}

TEST(Shutter, AnInstantIsOnePictureAtTheStamp) {
  const Shutter shutter(0.0, 0.0, 350.0);
  const FrameRequest request{.stamp = 5, .T_WB = kBody, .v_WB_m_s = {30.0, 0.0, 0.0}};
  ASSERT_EQ(shutter.SubFramesOf(request).size(), 1U);
  EXPECT_EQ(shutter.SubFramesOf(request)[0].stamp, 5);
}

}  // namespace
}  // namespace polnav::sim
