#include "nav/stereo/corners.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "tests/nav/spot_texture.h"

namespace polnav::nav {
namespace {

std::vector<cv::Point2f> CornersOf(const cv::Mat& image, const std::vector<cv::Point2f>& followed) {
  const TrackerOptions options;
  return FindCorners(BuildPyramid(image, options, true), followed, options);
}

TEST(Corners, NeitherPlainsNorEdgesHaveAny) {
  cv::Mat image(376, 672, CV_8UC1, cv::Scalar(60));
  EXPECT_TRUE(CornersOf(image, {}).empty());
  image.colRange(300, 672).setTo(180);
  EXPECT_TRUE(CornersOf(image, {}).empty()) << "an edge can slide along itself";
}

// Found at half size and over a window of 5 x 5 there: within its 5 px at full size.
TEST(Corners, ASquareHasFour) {
  cv::Mat image(376, 672, CV_8UC1, cv::Scalar(60));
  cv::rectangle(image, {300, 150}, {360, 210}, cv::Scalar(180), cv::FILLED);
  const std::vector<cv::Point2f> corners = CornersOf(image, {});
  for (const cv::Point2f expected : {cv::Point2f(300, 150), cv::Point2f(360, 150),
                                     cv::Point2f(300, 210), cv::Point2f(360, 210)}) {
    EXPECT_TRUE(std::any_of(corners.begin(), corners.end(), [&](const cv::Point2f& c) {
      return cv::norm(c - expected) < 5.0;
    })) << expected;
  }
}

TEST(Corners, KeepTheirDistanceFromWhatIsFollowedAndFillTheRest) {
  const cv::Mat image = SpotTexture(0.0, 0.0);
  const TrackerOptions options;
  const std::vector<cv::Point2f> all = CornersOf(image, {});
  EXPECT_GT(all.size(), 250U);
  EXPECT_LE(all.size(), static_cast<std::size_t>(options.max_features));
  const std::vector<cv::Point2f> kept(all.begin(), all.begin() + 200);
  const std::vector<cv::Point2f> fresh = CornersOf(image, kept);
  EXPECT_LE(kept.size() + fresh.size(), static_cast<std::size_t>(options.max_features));
  for (const cv::Point2f& f : fresh) {
    for (const cv::Point2f& k : kept) EXPECT_GE(cv::norm(f - k), options.min_distance_px - 1.5);
  }
}

}  // namespace
}  // namespace polnav::nav
