// A picture that moves by so much is said to have moved by so much, whatever the fraction of a
// pixel.
#include "sim/sensors/block_matching.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "sim/random.h"

namespace polnav::sim {
namespace {

// Sixty plane waves, none shorter than 6 px: what a lens leaves. turn_rad: about the middle.
cv::Mat Waves(const Eigen::Vector2d& shift_px, double turn_rad = 0.0, double grey = 120.0) {
  RandomStream::Sample random = RandomStream(3, 0, "waves").At(0);
  cv::Mat sum(64, 64, CV_64FC1, cv::Scalar(grey));
  for (int i = 0; i < 60; ++i) {
    const double k = random.Uniform();
    const double way = 2.0 * M_PI * random.Uniform();
    const double phase = 2.0 * M_PI * random.Uniform();
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 64; ++x) {
        const double dx = x - 31.5 - shift_px.x();
        const double dy = y - 31.5 - shift_px.y();
        const double u = std::cos(turn_rad) * dx + std::sin(turn_rad) * dy;
        const double v = std::cos(turn_rad) * dy - std::sin(turn_rad) * dx;
        sum.at<double>(y, x) += 6.0 * std::sin(k * (std::cos(way) * u + std::sin(way) * v) + phase);
      }
    }
  }
  cv::Mat picture;
  sum.convertTo(picture, CV_8U);
  return picture;
}

// Rounding to whole grey levels is 0.29 of one, slopes are some 2 a pixel: 0.1 px a pixel, over
// 25 x 64 of them 0.004 px; the interpolation adds 0.001.
TEST(BlockMatching, FindsAnyFractionOfAPixel) {
  const cv::Mat before = Waves({0.0, 0.0});
  for (const double x : {0.0, 0.1, 0.25, 0.5, 0.8, 1.3, -2.6, 4.2}) {
    const Eigen::Vector2d shift(x, -0.7 * x);
    const PictureShift found = MatchBlocks(before, Waves(shift));
    EXPECT_GE(found.matched, 15) << x;
    EXPECT_LT((found.shift_px - shift).cwiseAbs().maxCoeff(), 0.005) << x;
  }
}

TEST(BlockMatching, DoesNotTakeATurnForAShift) {
  const PictureShift found = MatchBlocks(Waves({0.0, 0.0}), Waves({0.3, -0.4}, 0.004));
  EXPECT_TRUE(found.valid());
  EXPECT_LT((found.shift_px - Eigen::Vector2d(0.3, -0.4)).cwiseAbs().maxCoeff(), 0.01);
}

TEST(BlockMatching, DoesNotTakeBrightnessForAShift) {
  const PictureShift found = MatchBlocks(Waves({0.0, 0.0}), Waves({0.3, -0.4}, 0.0, 128.0));
  EXPECT_LT((found.shift_px - Eigen::Vector2d(0.3, -0.4)).cwiseAbs().maxCoeff(), 0.005);
}

TEST(BlockMatching, SaysWhenThereIsNothingToSee) {
  const cv::Mat plain(64, 64, CV_8UC1, cv::Scalar(90));
  EXPECT_FALSE(MatchBlocks(plain, plain).valid());
  EXPECT_EQ(MatchBlocks(plain, plain).blocks, 25);
  EXPECT_FALSE(MatchBlocks(Waves({0.0, 0.0}), Waves({9.0, 0.0})).valid());
  EXPECT_THROW((void)MatchBlocks(plain, plain.rowRange(0, 40)), std::logic_error);
}

}  // namespace
}  // namespace polnav::sim
