#include "nav/stereo/tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <opencv2/calib3d.hpp>
#include <vector>

#include "tests/nav/spot_texture.h"
#include "tests/nav/synthetic_street.h"

namespace polnav::nav {
namespace {

cv::Mat Texture(double shift_x, double shift_y) { return SpotTexture(shift_x, shift_y); }

std::map<std::uint64_t, FeatureObservation> ById(const StereoFeatures& features) {
  std::map<std::uint64_t, FeatureObservation> by_id;
  for (const FeatureObservation& f : features.features) by_id[f.id] = f;
  return by_id;
}

TEST(StereoTracker, FollowsAPlaneInTimeAndAcrossToATenthOfAPixel) {
  StereoTracker tracker({}, TestCalibration());
  const double disparity = 7.3;
  const auto pair = [&](TimeNs stamp, double x, double y) {
    return StereoImages{stamp, Texture(x, y), Texture(x - disparity, y)};
  };
  const auto first = ById(tracker.Track(pair(0, 0.0, 0.0)));
  const auto second = ById(tracker.Track(pair(1, 4.4, -2.7)));
  int followed = 0;
  for (const auto& [id, now] : second) {
    const auto before = first.find(id);
    if (before == first.end() || !now.u_right_px) continue;
    ++followed;
    EXPECT_NEAR(now.uv_left_px.x() - before->second.uv_left_px.x(), 4.4, 0.1);
    EXPECT_NEAR(now.uv_left_px.y() - before->second.uv_left_px.y(), -2.7, 0.1);
    EXPECT_NEAR(now.uv_left_px.x() - *now.u_right_px, disparity, 0.1);
  }
  EXPECT_GT(followed, 100);
}

TEST(StereoTracker, SpreadsFeaturesOverTheImage) {
  StereoTracker tracker({}, TestCalibration());
  const StereoFeatures features = tracker.Track({0, Texture(0, 0), Texture(-7, 0)});
  std::array<int, 4> quarter{};
  for (const FeatureObservation& f : features.features) {
    ++quarter[(f.uv_left_px.x() > 336 ? 1 : 0) + (f.uv_left_px.y() > 188 ? 2 : 0)];
  }
  for (const int count : quarter) EXPECT_GT(count, 20);
}

TEST(StereoTracker, ABlankImageHasNothingToFollow) {
  StereoTracker tracker({}, TestCalibration());
  const cv::Mat blank(376, 672, CV_8UC1, cv::Scalar(90));
  EXPECT_TRUE(tracker.Track({0, blank, blank}).features.empty());
}

TEST(StereoTracker, AcceptsNoHalvesNothingLateAndNoPictureTwice) {
  StereoTracker tracker({}, TestCalibration());
  const cv::Mat a = Texture(0.0, 0.0);
  const cv::Mat b = Texture(1.0, 0.0);
  EXPECT_FALSE(tracker.Accepts({0, a, cv::Mat()}));
  EXPECT_FALSE(tracker.Accepts({0, cv::Mat(), a}));
  ASSERT_TRUE(tracker.Accepts({10, a, a}));
  (void)tracker.Track({10, a, a});
  EXPECT_FALSE(tracker.Accepts({10, b, b})) << "the same stamp";
  EXPECT_FALSE(tracker.Accepts({9, b, b})) << "late";
  EXPECT_FALSE(tracker.Accepts({20, a, a})) << "frozen";
  EXPECT_TRUE(tracker.Accepts({20, b, b}));
}

// Broken drivers and wires: refused before anything is touched, and the run goes on after them.
TEST(StereoTracker, RefusesPairsThatAreNotOfTheCalibrationsSize) {
  StereoTracker tracker({}, TestCalibration());
  const cv::Mat good = Texture(0.0, 0.0);
  const cv::Mat half(188, 336, CV_8UC1, cv::Scalar(90));
  const cv::Mat colour(376, 672, CV_8UC3, cv::Scalar(1, 2, 3));
  const cv::Mat deep(376, 672, CV_16UC1, cv::Scalar(300));
  EXPECT_FALSE(tracker.Accepts({0, good, half})) << "left and right differ";
  EXPECT_FALSE(tracker.Accepts({0, half, half})) << "not what was calibrated";
  EXPECT_FALSE(tracker.Accepts({0, colour, colour}));
  EXPECT_FALSE(tracker.Accepts({0, deep, deep}));
  EXPECT_FALSE(tracker.Accepts({0, cv::Mat(), cv::Mat()}));
  EXPECT_THROW((void)tracker.Track({0, half, half}), std::logic_error) << "a broken contract";
  EXPECT_TRUE(tracker.Accepts({0, good, good}));
}

TEST(StereoTracker, BlackAndWhitePicturesHaveNoFeaturesAndSightComesBack) {
  StereoTracker tracker({}, TestCalibration());
  const auto plain = [](int grey) { return cv::Mat(376, 672, CV_8UC1, cv::Scalar(grey)); };
  const StereoImages seen{0, Texture(0, 0), Texture(-7, 0)};
  EXPECT_GT(tracker.Track(seen).features.size(), 100U);
  EXPECT_TRUE(tracker.Track({1, plain(0), plain(0)}).features.empty());
  EXPECT_TRUE(tracker.Track({2, plain(255), plain(255)}).features.empty());
  EXPECT_GT(tracker.Track({3, seen.left, seen.right}).features.size(), 100U);
}

// A point far from the axis of a distorted, slightly turned pair: its rectified pixels must obey
// [Chu2021, eq. 14] in the virtual camera.
TEST(StereoRectifier, RowsCoincideAndDisparityIsBaselineTimesFocalLengthOverDepth) {
  StereoCalibration calibration = TestCalibration();
  calibration.left.distortion = calibration.right.distortion = {-0.17, 0.025, 3e-4, -2e-4};
  calibration.right.T_BC.q = calibration.right.T_BC.q * ExpRotation({0.004, -0.003, 0.005});
  const StereoRectifier rectifier(calibration);
  const RectifiedCamera& camera = rectifier.camera();
  const Eigen::Vector3d p_B(9.0, -4.0, 3.5);
  const auto project = [&](const CameraCalibration& c) {
    const Eigen::Vector3d p = c.T_BC.Inverse() * p_B;
    const std::vector<cv::Point3d> points{{p.x(), p.y(), p.z()}};
    std::vector<cv::Point2d> pixels;
    const cv::Matx33d k(c.fx_px, 0, c.cx_px, 0, c.fy_px, c.cy_px, 0, 0, 1);
    cv::projectPoints(points, cv::Vec3d(0, 0, 0), cv::Vec3d(0, 0, 0), k,
                      cv::Vec4d(c.distortion.data()), pixels);
    return std::vector<cv::Point2f>{pixels.front()};
  };
  const cv::Point2f left = rectifier.RectifyLeft(project(calibration.left)).front();
  const cv::Point2f right = rectifier.RectifyRight(project(calibration.right)).front();
  const Eigen::Vector3d p_C = camera.T_BC.Inverse() * p_B;
  // Single-precision pixels, and the inverse distortion's tolerance of 1e-3 px.
  EXPECT_NEAR(left.y, right.y, 3e-3);
  EXPECT_NEAR(left.x - right.x, camera.f_px * camera.baseline_m / p_C.z(), 3e-3);
  EXPECT_NEAR(left.x, camera.f_px * p_C.x() / p_C.z() + camera.cx_px, 3e-3);
}

}  // namespace
}  // namespace polnav::nav
