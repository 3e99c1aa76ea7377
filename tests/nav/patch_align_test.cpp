#include "nav/stereo/patch_align.h"

#include <gtest/gtest.h>

#include <cmath>

namespace polnav::nav {
namespace {

std::optional<PatchPlace> Align(const cv::Mat& from, const cv::Point2f& middle, const cv::Mat& to,
                                const PatchPlace& guess) {
  const auto patch = CutTemplate(from, middle, 5);
  return patch ? AlignTemplate(*patch, to, guess, 0.8F) : std::nullopt;
}

// Contrast all over, strongest to the lower right of the middle (100, 80).
double Grey(double x, double y) {
  const double strength = 20.0 + 25.0 / (1.0 + std::exp(-(x + y - 180.0) / 3.0));
  return 128.0 + strength * (std::sin(0.71 * x + 0.13 * y) + std::sin(0.62 * y - 0.21 * x));
}

// The texture carried along: what was at middle + d is seen at place + stretch d.
cv::Mat Picture(const PatchPlace& place, double gain = 1.0, double offset = 0.0) {
  const cv::Matx22f back = place.stretch.inv();
  cv::Mat image(160, 200, CV_8UC1);
  for (int row = 0; row < image.rows; ++row) {
    for (int col = 0; col < image.cols; ++col) {
      const double x = col - place.at.x;
      const double y = row - place.at.y;
      const double grey =
          Grey(100.0 + back(0, 0) * x + back(0, 1) * y, 80.0 + back(1, 0) * x + back(1, 1) * y);
      image.at<std::uint8_t>(row, col) = cv::saturate_cast<std::uint8_t>(gain * grey + offset);
    }
  }
  return image;
}

const cv::Point2f kMiddle(100.0F, 80.0F);

// Grey values are rounded, 0.3 of one, against slopes of some 15 a pixel over 121 pixels: 0.002 px,
// and the same over a lever of 3 px for the stretch; bilinear interpolation adds ten times that.
TEST(PatchAlign, FindsPlaceAndStretchOfGroundThatComesNearer) {
  const PatchPlace truth{{101.3F, 83.6F}, {1.2F, 0.08F, 0.0F, 1.35F}};
  const auto found = Align(Picture({kMiddle}), kMiddle, Picture(truth), {{102.0F, 83.0F}});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->at.x, truth.at.x, 0.04);
  EXPECT_NEAR(found->at.y, truth.at.y, 0.04);
  EXPECT_LT(cv::norm(found->stretch - truth.stretch), 0.04);
}

TEST(PatchAlign, DoesNotMindBrightnessAndContrast) {
  const PatchPlace truth{{100.6F, 79.8F}};
  const auto found = Align(Picture({kMiddle}), kMiddle, Picture(truth, 0.7, 40.0), {kMiddle});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->at.x, truth.at.x, 0.03);
  EXPECT_NEAR(found->at.y, truth.at.y, 0.03);
}

TEST(PatchAlign, SaysNothingOfPlainsEdgesAndOtherThings) {
  const cv::Mat plain(160, 200, CV_8UC1, cv::Scalar(90));
  EXPECT_FALSE(Align(plain, kMiddle, plain, {kMiddle}));
  cv::Mat edge = plain.clone();
  edge.colRange(100, 200).setTo(190);
  EXPECT_FALSE(Align(edge, kMiddle, edge, {kMiddle})) << "it can slide along itself";
  cv::Mat other(160, 200, CV_8UC1);
  cv::RNG(5).fill(other, cv::RNG::UNIFORM, 0, 256);
  EXPECT_FALSE(Align(Picture({kMiddle}), kMiddle, other, {kMiddle}));
}

TEST(PatchAlign, NeedsThePatchInsideBothPictures) {
  const cv::Mat image = Picture({kMiddle});
  EXPECT_FALSE(Align(image, {5.0F, 80.0F}, image, {{5.0F, 80.0F}}));
  EXPECT_FALSE(Align(image, kMiddle, image, {{196.0F, 80.0F}}));
}

}  // namespace
}  // namespace polnav::nav
