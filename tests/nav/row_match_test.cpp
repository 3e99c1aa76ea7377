#include "nav/stereo/row_match.h"

#include <gtest/gtest.h>

#include "nav/stereo/patch_flow.h"
#include "tests/nav/spot_texture.h"
#include "tests/nav/synthetic_street.h"

namespace polnav::nav {
namespace {

// Matches on a lattice of points of a picture and its copy with row r moved left by disparity(r),
// and how far they are off: median and the share beyond 0.3 px.
struct Outcomes {
  int matched = 0;
  int asked = 0;
  double mean_error_px = 0.0;
  double largest_px = 0.0;
};

Outcomes MatchAll(const std::function<double(int)>& disparity, double gain, double offset) {
  const TrackerOptions options;
  const StereoRectifier rectifier(TestCalibration());
  cv::Mat right = SpotTexture([&](int row) { return -disparity(row); }, 0.0);
  right.convertTo(right, CV_8UC1, gain, offset);
  const Pyramid left_pyramid = BuildPyramid(SpotTexture(0.0, 0.0), options, false);
  const Pyramid right_pyramid = BuildPyramid(right, options, false);
  RowMatcher matcher(options, rectifier, left_pyramid, right_pyramid);
  Outcomes outcomes;
  for (int y = 40; y < 340; y += 20) {
    for (int x = 160; x < 640; x += 20) {
      const cv::Point2f p(static_cast<float>(x), static_cast<float>(y));
      const std::optional<float> d = matcher.Match({p, p, std::nullopt});
      ++outcomes.asked;
      if (!d) continue;
      ++outcomes.matched;
      const double error = *d - disparity(y);
      outcomes.mean_error_px += error;
      outcomes.largest_px = std::max(outcomes.largest_px, std::abs(error));
    }
  }
  outcomes.mean_error_px /= outcomes.matched;
  return outcomes;
}

// Eight bits of grey and bilinear interpolation leave some hundredths.
TEST(RowMatcher, FindsAPlaneWithoutAFirstGuess) {
  const Outcomes o = MatchAll([](int) { return 23.37; }, 1.0, 0.0);
  EXPECT_GT(o.matched, o.asked * 8 / 10);
  EXPECT_NEAR(o.mean_error_px, 0.0, 0.01);
  EXPECT_LT(o.largest_px, 0.3);
}

// The ground a metre below a pair with a baseline of 0.3 m: the disparity grows by 0.3 px a row. A
// patch matched as a whole would answer for wherever its contrast is.
TEST(RowMatcher, AnswersForThePointAndNotForThePatchOnTheGround) {
  const Outcomes o = MatchAll([](int row) { return 4.0 + 0.3 * row; }, 1.0, 0.0);
  EXPECT_GT(o.matched, o.asked * 7 / 10);
  EXPECT_NEAR(o.mean_error_px, 0.0, 0.02);
  EXPECT_LT(o.largest_px, 0.5);
}

TEST(RowMatcher, DoesNotMindAnotherExposureOnTheRight) {
  const Outcomes o = MatchAll([](int) { return 12.6; }, 0.7, 25.0);
  EXPECT_GT(o.matched, o.asked * 8 / 10);
  EXPECT_NEAR(o.mean_error_px, 0.0, 0.01);
}

TEST(RowMatcher, FindsNothingInAnotherPicture) {
  const TrackerOptions options;
  const StereoRectifier rectifier(TestCalibration());
  const Pyramid left = BuildPyramid(SpotTexture(0.0, 0.0), options, false);
  const Pyramid right = BuildPyramid(SpotTexture(0.0, 150.0), options, false);
  RowMatcher matcher(options, rectifier, left, right);
  int matched = 0;
  for (int x = 160; x < 640; x += 10) {
    const cv::Point2f p(static_cast<float>(x), 190.0F);
    matched += matcher.Match({p, p, std::nullopt}) ? 1 : 0;
  }
  EXPECT_LT(matched, 3);  // of 48
}

}  // namespace
}  // namespace polnav::nav
