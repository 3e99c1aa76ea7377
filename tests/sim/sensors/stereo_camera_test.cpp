#include "sim/sensors/stereo_camera.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <thread>

#include "sim/sensors/lens.h"
#include "tests/sim/render/marker_scene.h"

namespace polnav::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const nav::Pose kBody{nav::LevelAttitude(2.0), {1.0, 2.0, 0.4}};

StereoCameraOptions Quiet() {
  StereoCameraOptions options;
  options.exposure = 0.3;
  options.full_well_e = 1e6;
  options.read_noise_e = 0.0;
  return options;
}

// Spots all over the left image, 3 to 30 m away.
std::vector<Vector3d> SpotsInLeftCamera(const nav::CameraCalibration& camera) {
  std::vector<Vector3d> points;
  int k = 0;
  for (const double u : {40.0, 190.0, 336.0, 480.0, 630.0}) {
    for (const double v : {40.0, 188.0, 335.0}) {
      points.push_back((3.0 + 2.0 * k++) * RayOfPixel(camera, u, v).homogeneous());
    }
  }
  return points;
}

Scene SpotScene(const nav::StereoCalibration& truth) {
  Scene scene = BlackRoom();
  for (const Vector3d& p_C : SpotsInLeftCamera(truth.left)) {
    AddSpot(kBody * truth.left.T_BC, p_C, truth.left.fx_px, scene);
  }
  return scene;
}

// Near the corners the lens squeezes a spot of sigma 3 px unevenly (its second derivative is some
// 0.001 / px): sigma^2 / 2 times that is 0.005 px. The warp adds 0.02, rounding of greys 0.01.
TEST(StereoCamera, ShowsPointsWhereTheTrueCalibrationSaysThroughTheLens) {
  const StereoCameraOptions options = Quiet();
  const nav::StereoCalibration truth = DrawTrueStereo(options, 7, 8);
  StereoCamera camera(SpotScene(truth), TestSky(), truth, options, 7, 8);
  const nav::StereoImages images = camera.Capture(kBody, 123, 0);
  EXPECT_EQ(images.stamp, 123);
  for (const Vector3d& p_C0 : SpotsInLeftCamera(truth.left)) {
    const Vector2d left = ProjectToPixel(truth.left, p_C0);
    EXPECT_LT((Centroid(images.left, left) - left).norm(), 0.08) << left.transpose();
    const nav::Pose T_RL = truth.right.T_BC.Inverse() * truth.left.T_BC;
    const Vector2d right = ProjectToPixel(truth.right, T_RL * p_C0);
    if (right.x() < 14.0) continue;  // the spot leaves the picture
    EXPECT_LT((Centroid(images.right, right) - right).norm(), 0.08) << right.transpose();
  }
}

// Two centroids, each good to some 0.03 px.
TEST(StereoCamera, SeesADisparityOfFocalLengthTimesBaselineOverDepth) {
  StereoCameraOptions options = Quiet();
  options.k1 = options.k2 = options.p1 = options.p2 = 0.0;
  const nav::StereoCalibration nominal = NominalStereo(options);
  for (const double z : {2.0, 5.0, 20.0}) {
    Scene scene = BlackRoom();
    const Vector3d p_C(0.1 * z, -0.05 * z, z);
    AddSpot(kBody * nominal.left.T_BC, p_C, options.focal_px, scene);
    StereoCamera camera(scene, TestSky(), nominal, options, 1, 1);
    const nav::StereoImages images = camera.Capture(kBody, 0, 0);
    const double disparity = options.focal_px * options.baseline_m / z;
    const Vector2d left = Centroid(images.left, ProjectToPixel(nominal.left, p_C));
    const Vector2d right = Centroid(images.right, left - Vector2d(disparity, 0.0));
    EXPECT_NEAR(left.x() - right.x(), disparity, 0.06);
    EXPECT_NEAR(left.y(), right.y(), 0.06);
  }
}

TEST(StereoCamera, IsAFunctionOfSeedTrialIndexAndPoseInAnyThread) {
  StereoCameraOptions options;
  options.exposure = 0.3;
  const nav::StereoCalibration truth = DrawTrueStereo(options, 7, 8);
  const Scene scene = SpotScene(truth);
  std::array<nav::StereoImages, 2> images;
  const auto work = [&](std::size_t i) {
    StereoCamera camera(scene, TestSky(), truth, options, 7, 8);
    // The second thread has taken another picture before.
    if (i == 1) static_cast<void>(camera.Capture({kBody.q, {0.0, 1.0, 0.0}}, 0, 3));
    images[i] = camera.Capture(kBody, 0, 5);
  };
  std::thread a(work, 0);
  std::thread b(work, 1);
  a.join();
  b.join();
  EXPECT_EQ(cv::norm(images[0].left, images[1].left, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(images[0].right, images[1].right, cv::NORM_INF), 0.0);
  StereoCamera camera(scene, TestSky(), truth, options, 7, 8);
  EXPECT_GT(cv::norm(camera.Capture(kBody, 0, 6).left, images[0].left, cv::NORM_INF), 0.0);
}

TEST(StereoCamera, FindsTheExposureThatMeetsTheTargetMeanFromTheOrigin) {
  StereoCameraOptions options;
  options.full_well_e = 1e6;
  const nav::StereoCalibration nominal = NominalStereo(options);
  const Scene empty;  // sky alone, which saturates near the sun
  StereoCamera camera(empty, TestSky(), nominal, options, 1, 1);
  double mean = 0.0;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const nav::Pose T_WB{nav::LevelAttitude(0.5 * M_PI * quarter), Vector3d::Zero()};
    mean += 0.25 * cv::mean(camera.Capture(T_WB, 0, 0).left)[0];
  }
  // The search ends within a few thousandths; the noise is a grey level or less.
  EXPECT_NEAR(mean, options.target_mean, 0.01 * options.target_mean);
}

TEST(DrawTrueStereo, IsNominalWithoutErrorsAndSpreadsAsAskedWithThem) {
  StereoCameraOptions exact;
  exact.calibration_error = {.focal_sigma_px = 0.0,
                             .center_sigma_px = 0.0,
                             .distortion_sigma = 0.0,
                             .relative_share = 0.0,
                             .relative_rotation_sigma_deg = 0.0,
                             .baseline_sigma_m = 0.0,
                             .mount_rotation_sigma_deg = 0.0};
  const nav::StereoCalibration nominal = NominalStereo(exact);
  const nav::StereoCalibration same = DrawTrueStereo(exact, 1, 2);
  EXPECT_EQ(same.right.fx_px, nominal.right.fx_px);
  EXPECT_LT((same.right.T_BC.p - nominal.right.T_BC.p).norm(), 1e-12);

  const StereoCameraOptions options;
  constexpr int kTrials = 400;
  double focal = 0.0;
  double baseline = 0.0;
  double turn = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const nav::StereoCalibration truth =
        DrawTrueStereo(options, 1, static_cast<std::uint64_t>(trial));
    focal += std::pow(truth.left.fx_px - options.focal_px, 2);
    const nav::Pose T_LR = truth.left.T_BC.Inverse() * truth.right.T_BC;
    baseline += std::pow(T_LR.p.x() - options.baseline_m, 2);
    turn += std::pow(T_LR.q.angularDistance(Eigen::Quaterniond::Identity()), 2) / 3.0;
  }
  // Root mean squares over 400 trials are good to 1 / sqrt(800) = 3.5 %: four of them.
  const StereoCalibrationErrorOptions& error = options.calibration_error;
  EXPECT_NEAR(std::sqrt(focal / kTrials), error.focal_sigma_px, 0.14 * error.focal_sigma_px);
  EXPECT_NEAR(std::sqrt(baseline / kTrials), error.baseline_sigma_m, 0.14 * error.baseline_sigma_m);
  const double rotation = nav::DegToRad(error.relative_rotation_sigma_deg);
  EXPECT_NEAR(std::sqrt(turn / kTrials), rotation, 0.14 * rotation);
}

}  // namespace
}  // namespace polnav::sim
