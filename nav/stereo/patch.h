// What does an image show around a point?
//
// Square patches of (2 half + 1)^2 grey values, row by row, between the pixels by bilinear
// interpolation. Fast where the patch keeps its shape, slower where it is sheared.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace polnav::nav {

using Patch = std::vector<float>;

// False, and `patch` undefined, where the patch does not lie inside the image.
[[nodiscard]] bool ReadPatch(const cv::Mat& image, const cv::Point2f& center, int half,
                             Patch& patch);

// The same where the column i and the row j lie at center + stretch (i, j). half: at most 31.
[[nodiscard]] bool ReadWarped(const cv::Mat& image, const cv::Point2f& center,
                              const cv::Matx22f& stretch, int half, Patch& patch);

// Calls take(k, i, j, grey, slope_x, slope_y) for each pixel, row by row, (i, j) from the middle,
// by central differences [grey values per pixel]. wide: a patch of half + 1.
template <typename Take>
void ForEachSlope(const Patch& wide, int half, Take take) {
  const int width = 2 * half + 3;
  int k = 0;
  for (int j = -half; j <= half; ++j) {
    const float* here = wide.data() + (j + half + 1) * width + 1;
    for (int i = -half; i <= half; ++i, ++k, ++here) {
      take(k, static_cast<float>(i), static_cast<float>(j), here[0], 0.5F * (here[1] - here[-1]),
           0.5F * (here[width] - here[-width]));
    }
  }
}

// Correlation from -1 to 1 after mean and contrast are taken out; 0 where there is no contrast.
[[nodiscard]] float Correlation(const Patch& a, const Patch& b);

}  // namespace polnav::nav
