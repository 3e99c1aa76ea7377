// A picture of random light and dark Gaussian spots, evaluated at the shifted pixels themselves:
// interpolating one picture to make another would move it by up to 0.05 px more than asked.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/core.hpp>

namespace polnav::nav {

// Row r of the picture shows the texture shifted right by shift_x(r), all of it down by shift_y.
inline cv::Mat SpotTexture(const std::function<double(int)>& shift_x, double shift_y) {
  constexpr double kSigma_px = 2.5;
  constexpr int kReach_px = 10;
  cv::RNG random(11);
  cv::Mat sum = cv::Mat::zeros(376, 672, CV_32FC1);
  const auto bell = [](double distance) {
    return static_cast<float>(std::exp(-0.5 * distance * distance / (kSigma_px * kSigma_px)));
  };
  for (int spot = 0; spot < 20000; ++spot) {
    const double x = random.uniform(-150.0, 822.0);
    const double y = random.uniform(-30.0, 406.0) + shift_y;
    const auto strength = static_cast<float>(random.gaussian(1.0));
    const int first_row = std::max(0, static_cast<int>(std::floor(y)) - kReach_px);
    const int last_row = std::min(sum.rows - 1, static_cast<int>(std::floor(y)) + kReach_px);
    for (int row = first_row; row <= last_row; ++row) {
      const double at = x + shift_x(row);
      const float down = strength * bell(row - y);
      const int first = std::max(0, static_cast<int>(std::floor(at)) - kReach_px);
      const int last = std::min(sum.cols - 1, static_cast<int>(std::floor(at)) + kReach_px);
      for (int col = first; col <= last; ++col) sum.at<float>(row, col) += down * bell(col - at);
    }
  }
  cv::Mat grey;
  sum.convertTo(grey, CV_8UC1, 127.0 / 5.0, 127.5);  // spots overlap: one sigma is about 1.2
  return grey;
}

inline cv::Mat SpotTexture(double shift_x, double shift_y) {
  return SpotTexture([shift_x](int) { return shift_x; }, shift_y);
}

}  // namespace polnav::nav
