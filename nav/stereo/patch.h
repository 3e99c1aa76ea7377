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

// The same where the column i and the row j lie at center + stretch (i, j).
[[nodiscard]] bool ReadWarped(const cv::Mat& image, const cv::Point2f& center,
                              const cv::Matx22f& stretch, int half, Patch& patch);

// Correlation from -1 to 1 after mean and contrast are taken out; 0 where there is no contrast.
[[nodiscard]] float Correlation(const Patch& a, const Patch& b);

}  // namespace polnav::nav
