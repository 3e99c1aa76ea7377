#include "nav/stereo/patch.h"

#include <cmath>
#include <cstdint>

namespace polnav::nav {

bool ReadPatch(const cv::Mat& image, const cv::Point2f& center, int half, Patch& patch) {
  const float left = std::floor(center.x);
  const float top = std::floor(center.y);
  const float reach = static_cast<float>(half);
  const bool inside = left >= reach && top >= reach &&
                      left + reach + 1.0F < static_cast<float>(image.cols) &&
                      top + reach + 1.0F < static_cast<float>(image.rows);
  if (!inside) return false;
  const int side = 2 * half + 1;
  patch.resize(static_cast<std::size_t>(side * side));
  const float fx = center.x - left;
  const float fy = center.y - top;
  const float w00 = (1.0F - fx) * (1.0F - fy);
  const float w10 = fx * (1.0F - fy);
  const float w01 = (1.0F - fx) * fy;
  const float w11 = fx * fy;
  const int first = static_cast<int>(left) - half;
  float* out = patch.data();
  for (int j = 0; j < side; ++j, out += side) {
    const std::uint8_t* upper = image.ptr<std::uint8_t>(static_cast<int>(top) - half + j) + first;
    const std::uint8_t* lower =
        image.ptr<std::uint8_t>(static_cast<int>(top) - half + j + 1) + first;
    for (int i = 0; i < side; ++i) {
      out[i] = w00 * upper[i] + w10 * upper[i + 1] + w01 * lower[i] + w11 * lower[i + 1];
    }
  }
  return true;
}

bool ReadWarped(const cv::Mat& image, const cv::Point2f& center, const cv::Matx22f& stretch,
                int half, Patch& patch) {
  const float reach = static_cast<float>(half);
  const float wide = reach * (std::abs(stretch(0, 0)) + std::abs(stretch(0, 1))) + 1.0F;
  const float high = reach * (std::abs(stretch(1, 0)) + std::abs(stretch(1, 1))) + 1.0F;
  const bool inside = center.x >= wide && center.y >= high &&
                      center.x + wide < static_cast<float>(image.cols - 1) &&
                      center.y + high < static_cast<float>(image.rows - 1);
  if (!inside) return false;
  const int side = 2 * half + 1;
  patch.resize(static_cast<std::size_t>(side * side));
  float* out = patch.data();
  for (int j = -half; j <= half; ++j) {
    const cv::Point2f from(center.x + stretch(0, 1) * static_cast<float>(j),
                           center.y + stretch(1, 1) * static_cast<float>(j));
    for (int i = -half; i <= half; ++i) {
      const float x = from.x + stretch(0, 0) * static_cast<float>(i);
      const float y = from.y + stretch(1, 0) * static_cast<float>(i);
      // Inside the image, and so not negative: the cast is the floor.
      const int column = static_cast<int>(x);
      const int row = static_cast<int>(y);
      const float fx = x - static_cast<float>(column);
      const float fy = y - static_cast<float>(row);
      const std::uint8_t* upper = image.ptr<std::uint8_t>(row) + column;
      const std::uint8_t* lower = image.ptr<std::uint8_t>(row + 1) + column;
      const float above = upper[0] + fx * static_cast<float>(upper[1] - upper[0]);
      const float below = lower[0] + fx * static_cast<float>(lower[1] - lower[0]);
      *out++ = above + fy * (below - above);
    }
  }
  return true;
}

float Correlation(const Patch& a, const Patch& b) {
  float sum_a = 0.0F;
  float sum_b = 0.0F;
  float aa = 0.0F;
  float bb = 0.0F;
  float ab = 0.0F;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum_a += a[i];
    sum_b += b[i];
    aa += a[i] * a[i];
    bb += b[i] * b[i];
    ab += a[i] * b[i];
  }
  const float n = static_cast<float>(a.size());
  const float variance = (aa - sum_a * sum_a / n) * (bb - sum_b * sum_b / n);
  return variance > 1.0F ? (ab - sum_a * sum_b / n) / std::sqrt(variance) : 0.0F;
}

}  // namespace polnav::nav
