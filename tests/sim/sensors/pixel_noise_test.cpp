#include "sim/sensors/pixel_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

namespace polnav::sim {
namespace {

constexpr double kFullWell_e = 6000.0;
constexpr double kRead_e = 6.0;

cv::Mat Noisy(int grey, std::array<std::uint32_t, 2> key) {
  cv::Mat image(376, 672, CV_8UC1, cv::Scalar(grey));
  PixelNoise(kFullWell_e, kRead_e).Add(key, image);
  return image;
}

// Shot and read noise, and 1/12 from rounding. Of n = 252672 pixels the variance is known to
// sqrt(2 / n) = 0.28 %, the mean to sigma / 500: five sigma each.
TEST(PixelNoise, HasTheVarianceOfElectronsPlusReadNoise) {
  for (const int grey : {20, 60, 110, 200}) {
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(Noisy(grey, {17, 99}), mean, deviation);
    const double per_electron = 255.0 / kFullWell_e;
    const double electrons = grey / per_electron;
    const double variance = (electrons + kRead_e * kRead_e) * per_electron * per_electron;
    EXPECT_NEAR(deviation[0] * deviation[0], variance + 1.0 / 12.0, 0.014 * (variance + 0.1));
    EXPECT_NEAR(mean[0], grey, 5.0 * std::sqrt(variance) / 500.0);
  }
}

double Correlation(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat x;
  cv::Mat y;
  a.convertTo(x, CV_64F);
  b.convertTo(y, CV_64F);
  x -= cv::mean(x);
  y -= cv::mean(y);
  return x.dot(y) / std::sqrt(x.dot(x) * y.dot(y));
}

// The correlation of n independent pairs has a sigma of 1 / sqrt(n) = 0.002: five of them.
TEST(PixelNoise, IsIndependentBetweenFramesAndNeighbours) {
  const cv::Mat a = Noisy(110, {1, 2});
  EXPECT_LT(std::abs(Correlation(a, Noisy(110, {2, 2}))), 0.01);
  EXPECT_LT(std::abs(Correlation(a, Noisy(110, {1, 3}))), 0.01);
  const cv::Rect all(0, 0, a.cols - 1, a.rows - 1);
  EXPECT_LT(std::abs(Correlation(a(all), a(all + cv::Point(1, 0)))), 0.01);
  EXPECT_LT(std::abs(Correlation(a(all), a(all + cv::Point(0, 1)))), 0.01);
}

TEST(PixelNoise, IsAFunctionOfItsKey) {
  EXPECT_EQ(cv::norm(Noisy(90, {5, 6}), Noisy(90, {5, 6}), cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(Noisy(90, {5, 6}), Noisy(90, {5, 7}), cv::NORM_INF), 0.0);
}

}  // namespace
}  // namespace polnav::sim
