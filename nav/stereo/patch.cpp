#include "nav/stereo/patch.h"

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>

namespace polnav::nav {
namespace {

// Wider than any patch that the options allow; a fixed size lets loops run over registers.
constexpr int kMostSide = 64;

// Reads a patch's rows. Loops that differ in nothing but what they do with four numbers at once are
// kept apart, because only the one in the middle has to go pixel by pixel.
class WarpedRow {
 public:
  WarpedRow(const cv::Mat& image, const cv::Matx22f& stretch, int half)
      : image_(image), stretch_(stretch), half_(half), side_(2 * half + 1) {}

  void Read(const cv::Point2f& middle, float* out) {
    for (int i = 0; i < side_; ++i) {
      const auto k = static_cast<float>(i - half_);
      const float x = middle.x + stretch_(0, 0) * k;
      const float y = middle.y + stretch_(1, 0) * k;
      // Inside the image, and so not negative: the cast is the floor.
      column_[i] = static_cast<int>(x);
      row_[i] = static_cast<int>(y);
      fx_[i] = x - static_cast<float>(column_[i]);
      fy_[i] = y - static_cast<float>(row_[i]);
    }
    const std::size_t step = image_.step[0];
    for (int i = 0; i < side_; ++i) {
      const std::uint8_t* upper =
          image_.data + static_cast<std::size_t>(row_[i]) * step + column_[i];
      const std::uint8_t* lower = upper + step;
      grey_[0][i] = upper[0];
      grey_[1][i] = upper[1];
      grey_[2][i] = lower[0];
      grey_[3][i] = lower[1];
    }
    for (int i = 0; i < side_; ++i) {
      const auto a = static_cast<float>(grey_[0][i]);
      const auto c = static_cast<float>(grey_[2][i]);
      const float above = a + fx_[i] * (static_cast<float>(grey_[1][i]) - a);
      const float below = c + fx_[i] * (static_cast<float>(grey_[3][i]) - c);
      out[i] = above + fy_[i] * (below - above);
    }
  }

 private:
  const cv::Mat& image_;
  cv::Matx22f stretch_;
  int half_;
  int side_;
  std::array<int, kMostSide> column_;
  std::array<int, kMostSide> row_;
  std::array<float, kMostSide> fx_;
  std::array<float, kMostSide> fy_;
  std::array<std::array<std::int32_t, kMostSide>, 4> grey_;
};

}  // namespace

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
  WarpedRow row(image, stretch, half);
  for (int j = -half; j <= half; ++j) {
    const cv::Point2f from(center.x + stretch(0, 1) * static_cast<float>(j),
                           center.y + stretch(1, 1) * static_cast<float>(j));
    row.Read(from, patch.data() + (j + half) * side);
  }
  return true;
}

float Correlation(const Patch& a, const Patch& b) {
  const Eigen::Map<const Eigen::ArrayXf> left(a.data(), std::ssize(a));
  const Eigen::Map<const Eigen::ArrayXf> right(b.data(), std::ssize(b));
  const float sum_a = left.sum();
  const float sum_b = right.sum();
  const float n = static_cast<float>(a.size());
  const float aa = left.square().sum() - sum_a * sum_a / n;
  const float bb = right.square().sum() - sum_b * sum_b / n;
  const float variance = aa * bb;
  return variance > 1.0F ? ((left * right).sum() - sum_a * sum_b / n) / std::sqrt(variance) : 0.0F;
}

}  // namespace polnav::nav
