#include "nav/stereo/patch.h"

#include <gtest/gtest.h>

namespace polnav::nav {
namespace {

// Bilinear interpolation is exact on a slope.
TEST(Patch, ReadsBetweenThePixels) {
  cv::Mat image(40, 50, CV_8UC1);
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 50; ++x)
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(2 * x + 3 * y);
  }
  Patch plain;
  Patch sheared;
  ASSERT_TRUE(ReadPatch(image, {20.25F, 15.5F}, 2, plain));
  ASSERT_TRUE(ReadWarped(image, {20.25F, 15.5F}, {0.9F, -0.2F, 0.0F, 1.0F}, 2, sheared));
  std::size_t k = 0;
  for (int j = -2; j <= 2; ++j) {
    for (int i = -2; i <= 2; ++i, ++k) {
      EXPECT_NEAR(plain[k], 2.0 * (20.25 + i) + 3.0 * (15.5 + j), 1e-3);
      EXPECT_NEAR(sheared[k], 2.0 * (20.25 + i - 0.1 * i - 0.2 * j) + 3.0 * (15.5 + j), 1e-3);
    }
  }
}

TEST(Patch, HasToLieInside) {
  const cv::Mat image(40, 50, CV_8UC1, cv::Scalar(7));
  Patch patch;
  EXPECT_TRUE(ReadPatch(image, {5.0F, 5.0F}, 5, patch));
  EXPECT_FALSE(ReadPatch(image, {4.9F, 5.0F}, 5, patch));
  EXPECT_FALSE(ReadPatch(image, {44.5F, 5.0F}, 5, patch));
  EXPECT_FALSE(ReadWarped(image, {-3.0F, 5.0F}, cv::Matx22f::eye(), 5, patch));
}

TEST(Patch, CorrelationDoesNotMindGainAndOffset) {
  const Patch a{1, 5, 2, 8, 3, 9, 4, 7, 6};
  Patch b = a;
  for (float& grey : b) grey = 40.0F + 3.0F * grey;
  EXPECT_NEAR(Correlation(a, b), 1.0, 1e-4);
  for (float& grey : b) grey = -grey;
  EXPECT_NEAR(Correlation(a, b), -1.0, 1e-4);
  EXPECT_EQ(Correlation(a, Patch(9, 5.0F)), 0.0F);
}

}  // namespace
}  // namespace polnav::nav
