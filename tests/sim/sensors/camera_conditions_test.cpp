#include "sim/sensors/camera_conditions.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "sim/sensors/lens.h"
#include "sim/sensors/lens_dirt.h"
#include "sim/sensors/lens_rain.h"
#include "sim/sensors/stereo_camera.h"
#include "tests/sim/render/marker_scene.h"

namespace polnav::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const nav::Pose kBody{nav::LevelAttitude(2.0), {1.0, 2.0, 0.4}};

StereoCameraOptions Quiet() {
  StereoCameraOptions options;
  options.exposure = 0.1;
  options.full_well_e = 1e6;
  options.read_noise_e = 0.0;
  return options;
}

// A white wall, square to the left camera, that fills both pictures.
Scene WhiteWall(const nav::StereoCalibration& camera) {
  Scene scene = BlackRoom();
  const nav::Pose T_WC = kBody * camera.left.T_BC;
  const auto at = [&](double x, double y) { return Vector3d(T_WC * Vector3d(x, y, 10.0)); };
  AddQuad({at(-30, 30), at(30, 30), at(30, -30), at(-30, -30)}, 2, scene);
  return scene;
}

class ConditionsOnAWhiteWall : public testing::Test {
 protected:
  nav::StereoImages Picture(const CameraConditions& conditions, nav::TimeNs stamp = 0) {
    return camera.Capture({.stamp = stamp, .T_WB = kBody, .conditions = conditions});
  }
  StereoCameraOptions options = Quiet();
  nav::StereoCalibration truth = NominalStereo(options);
  StereoCamera camera{WhiteWall(truth), TestSky(), truth, options, 1, 1};
};

// Greys are linear in light; rounding is half a grey level, noise a tenth on average of many.
TEST_F(ConditionsOnAWhiteWall, GreysFollowTheLightAndTheGain) {
  const double plain = cv::mean(Picture({}).left)[0];
  ASSERT_GT(plain, 20.0);
  ASSERT_LT(plain, 120.0);
  EXPECT_NEAR(cv::mean(Picture({.light_share = 0.5}).left)[0], 0.5 * plain, 0.6);
  EXPECT_NEAR(cv::mean(Picture({.gain_share = 2.0}).left)[0], 2.0 * plain, 1.0);
  EXPECT_NEAR(cv::mean(Picture({.light_share = 0.25, .gain_share = 4.0}).right)[0],
              cv::mean(Picture({}).right)[0], 0.6);
  EXPECT_GT(cv::countNonZero(Picture({.gain_share = 20.0}).left >= 250),
            0.99 * options.width_px * options.height_px);
}

// The electrons behind a grey level are a quarter at four times the gain: noise doubles.
TEST(CameraConditions, GainMakesNoise) {
  StereoCameraOptions options = Quiet();
  options.full_well_e = 6000.0;
  const nav::StereoCalibration truth = NominalStereo(options);
  StereoCamera camera(WhiteWall(truth), TestSky(), truth, options, 1, 1);
  const auto noise = [&](const CameraConditions& conditions) {
    cv::Scalar mean;
    cv::Scalar sigma;
    const cv::Mat image = camera.Capture({.T_WB = kBody, .conditions = conditions}).left;
    cv::meanStdDev(image(cv::Rect(300, 150, 80, 80)), mean, sigma);
    return std::sqrt(sigma[0] * sigma[0] - 1.0 / 12.0);
  };
  // A sigma from 6400 pixels is good to 1 %; five of them each.
  EXPECT_NEAR(noise({.light_share = 0.25, .gain_share = 4.0}), 2.0 * noise({}),
              0.1 * 2.0 * noise({}));
}

TEST(Vignetting, DarkensByTheFourthPowerOfTheCosine) {
  StereoCameraOptions options = Quiet();
  const nav::StereoCalibration truth = NominalStereo(options);
  const Scene wall = WhiteWall(truth);
  const cv::Mat without =
      StereoCamera(wall, TestSky(), truth, options, 1, 1).Capture(kBody, 0, 0).left;
  for (const double share : {0.3, 1.0}) {
    options.vignetting = share;
    const cv::Mat with =
        StereoCamera(wall, TestSky(), truth, options, 1, 1).Capture(kBody, 0, 0).left;
    for (const int u : {10, 150, 336, 600}) {
      for (const int v : {10, 100, 188, 360}) {
        const Vector3d ray = RayOfPixel(truth.left, u, v).homogeneous().normalized();
        const double left = 1.0 - share + share * std::pow(ray.z(), 4);
        // Grey steps are doubled at most by the headroom: two levels.
        EXPECT_NEAR(with.at<std::uint8_t>(v, u), left * without.at<std::uint8_t>(v, u), 2.0);
      }
    }
  }
}

cv::Mat Grey(int grey) { return {376, 672, CV_8UC1, cv::Scalar(grey)}; }

// Where a uniform picture is changed, the blotch's glow shows its cover: half the grey, nine tenths
// opaque.
cv::Mat CoverOf(double share, const std::string& name) {
  cv::Mat image = Grey(200);
  LensDirt(image.size(), RandomStream(3, 4, name)).Apply(share, image);
  cv::Mat cover;
  image.convertTo(cover, CV_64F, -1.0 / 90.0, 200.0 / 90.0);
  return cover;
}

TEST(LensDirt, CoversItsShareOfTheLensMoreOfItTheSamePlaces) {
  const cv::Mat some = CoverOf(0.1, "left");
  const cv::Mat more = CoverOf(0.3, "left");
  // Soft edges are counted by how much they hide; where the field is skewed that errs a little.
  EXPECT_NEAR(cv::mean(some)[0], 0.1, 0.04);
  EXPECT_NEAR(cv::mean(more)[0], 0.3, 0.04);
  EXPECT_EQ(cv::countNonZero(some > more + 1e-9), 0);
  EXPECT_GT(cv::countNonZero(more > 0.9), 0.05 * 376 * 672);
}

TEST(LensDirt, StaysWhereItIsAndDiffersBetweenTheEyes) {
  EXPECT_EQ(cv::norm(CoverOf(0.2, "left"), CoverOf(0.2, "left"), cv::NORM_INF), 0.0);
  const cv::Mat difference = cv::abs(CoverOf(0.2, "left") - CoverOf(0.2, "right"));
  // Independent: one of both is covered on 2 x 0.2 x 0.8 of the lens.
  EXPECT_GT(cv::mean(difference)[0], 0.2);
}

// Stripes of a pixel vanish under a drop that is out of focus.
cv::Mat Stripes() {
  cv::Mat image(376, 672, CV_8UC1);
  for (int row = 0; row < image.rows; ++row) image.row(row) = row % 2 == 0 ? 60 : 180;
  return image;
}

cv::Mat UnderDrops(double share, nav::TimeNs stamp, const std::string& name = "left") {
  cv::Mat image = Stripes();
  LensRain(RandomStream(3, 4, name)).Apply(share, stamp, image);
  return cv::abs(image - Stripes()) > 20;
}

double ShareOf(const cv::Mat& mask) {
  return cv::countNonZero(mask) / static_cast<double>(mask.total());
}

TEST(LensRain, WetsItsShareOfTheLens) {
  for (const double share : {0.1, 0.3}) {
    double mean = 0.0;
    for (int k = 0; k < 10; ++k)
      mean += 0.1 * ShareOf(UnderDrops(share, nav::FromSeconds(3.0 * k)));
    // Some 30 or 100 drops of very different sizes, ten times: good to a tenth. The edge counts
    // where a third is hidden, which is beyond the middle of it.
    EXPECT_NEAR(mean, share, 0.25 * share);
  }
}

TEST(LensRain, ChangesWithinTwoSecondsAndHardlyWithinAFiftieth) {
  const cv::Mat first = UnderDrops(0.2, nav::FromSeconds(10.0));
  const double drops = ShareOf(first);
  EXPECT_LT(ShareOf(first ^ UnderDrops(0.2, nav::FromSeconds(10.02))), 0.15 * drops);
  // All have moved on: what is common is chance.
  EXPECT_GT(ShareOf(first ^ UnderDrops(0.2, nav::FromSeconds(12.1))), 1.2 * drops);
  EXPECT_GT(ShareOf(first ^ UnderDrops(0.2, nav::FromSeconds(10.0), "right")), 1.2 * drops);
  EXPECT_EQ(ShareOf(first ^ UnderDrops(0.2, nav::FromSeconds(10.0))), 0.0);
}

TEST_F(ConditionsOnAWhiteWall, DirtAndDropsReachTheirEyes) {
  const nav::StereoImages clean = Picture({});
  const nav::StereoImages dirty = Picture({.dirt_share = 0.2});
  for (const auto& [a, b] : {std::pair(clean.left, dirty.left), {clean.right, dirty.right}}) {
    EXPECT_GT(cv::countNonZero(cv::abs(a - b) > 10), 0.1 * static_cast<double>(a.total()));
  }
  const cv::Mat left = cv::abs(clean.left - dirty.left) > 10;
  const cv::Mat right = cv::abs(clean.right - dirty.right) > 10;
  EXPECT_GT(cv::countNonZero(left ^ right), 0.1 * static_cast<double>(left.total()));
  // Drops on a plain wall show by their dark rims.
  EXPECT_GT(cv::norm(clean.left, Picture({.rain_share = 0.3}).left, cv::NORM_INF), 5.0);
}

}  // namespace
}  // namespace polnav::sim
