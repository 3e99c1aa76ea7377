// What each look leaves of a picture, and how much of it.
#include "sim/faults/corruption.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

namespace polnav::sim {
namespace {

cv::Mat Flat(int type = CV_8UC1) { return {320, 480, type, cv::Scalar(77)}; }

cv::Mat CorruptedFlat(const CorruptFault& fault, int type = CV_8UC1, double full_scale = 255.0) {
  RandomStream::Sample draw = RandomStream(1, 0, "corruption").At(3);
  const cv::Mat original = Flat(type);
  cv::Mat corrupted = Corrupted(fault, full_scale, original, draw);
  EXPECT_EQ(cv::countNonZero(original != 77), 0);  // others may hold it
  return corrupted;
}

TEST(Corruption, GarbageIsOneBandOfRows) {
  const cv::Mat image = CorruptedFlat({.look = "garbage_rows", .share = 0.25});
  int hit = 0;
  int first = -1;
  int last = -1;
  for (int row = 0; row < image.rows; ++row) {
    if (cv::countNonZero(image.row(row) != 77) == 0) continue;
    ++hit;
    last = row;
    if (first < 0) first = row;
  }
  EXPECT_EQ(hit, 80);  // a row of 480 random bytes that are all 77 never comes
  EXPECT_EQ(last - first + 1, hit);
  cv::Scalar mean;
  cv::Scalar sigma;
  cv::meanStdDev(image.rowRange(first, last + 1), mean, sigma);
  EXPECT_NEAR(mean[0], 127.5, 4.0 * 73.9 / std::sqrt(80.0 * 480.0));  // uniform bytes
}

TEST(Corruption, LostBlocksAreGrey) {
  const cv::Mat image = CorruptedFlat({.look = "lost_blocks", .share = 0.3});
  const int grey = cv::countNonZero(image == 127);
  EXPECT_EQ(grey + cv::countNonZero(image == 77), 320 * 480);
  EXPECT_EQ(grey % 256, 0);
  // 600 blocks: binomial.
  EXPECT_NEAR(grey / 256.0, 180.0, 4.0 * std::sqrt(600.0 * 0.3 * 0.7));
}

TEST(Corruption, AFlippedByteDiffersByOneBit) {
  for (const bool wide : {false, true}) {
    const cv::Mat image = CorruptedFlat({.look = "bit_flips", .share = 0.01},
                                        wide ? CV_16UC1 : CV_8UC1, wide ? 4095.0 : 255.0);
    int hit = 0;
    for (int row = 0; row < image.rows; ++row) {
      for (int column = 0; column < image.cols; ++column) {
        const int value =
            wide ? image.at<std::uint16_t>(row, column) : image.at<std::uint8_t>(row, column);
        const int changed = value ^ 77;
        if (changed == 0) continue;
        ++hit;
        EXPECT_EQ(changed & (changed - 1), 0);
        EXPECT_LT(value, wide ? 4096 : 256);
      }
    }
    EXPECT_NEAR(hit, 1536.0, 4.0 * std::sqrt(1536.0 * 0.99));
  }
}

TEST(Corruption, BlackAndMissing) {
  EXPECT_EQ(cv::countNonZero(CorruptedFlat({.look = "black"})), 0);
  EXPECT_TRUE(CorruptedFlat({.look = "missing"}).empty());
}

}  // namespace
}  // namespace polnav::sim
