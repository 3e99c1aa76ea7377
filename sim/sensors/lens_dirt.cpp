#include "sim/sensors/lens_dirt.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace polnav::sim {
namespace {

constexpr int kCoarser = 4;
constexpr double kOpacity = 0.9;
constexpr double kGlow = 0.5;  // of the picture's mean
constexpr float kEdge = 0.8F;  // half the width of a blotch's edge, in sigmas of the field

// Correlated over this share of the picture's width.
cv::Mat SmoothField(const cv::Mat& white, double width_share) {
  cv::Mat field;
  cv::GaussianBlur(white, field, {}, width_share * white.cols, 0.0, cv::BORDER_REFLECT);
  cv::Scalar mean;
  cv::Scalar sigma;
  cv::meanStdDev(field, mean, sigma);
  field = (field - mean[0]) / sigma[0];
  return field;
}

}  // namespace

LensDirt::LensDirt(const cv::Size& size, const RandomStream& stream) : size_(size) {
  cv::Mat white((size.height + kCoarser - 1) / kCoarser, (size.width + kCoarser - 1) / kCoarser,
                CV_32FC1);
  RandomStream::Sample draw = stream.At(0);
  for (float& value : cv::Mat_<float>(white)) value = static_cast<float>(draw.Gaussian());
  const cv::Mat blotches = SmoothField(white, 0.022);
  const cv::Mat grain = SmoothField(white, 0.008);
  field_ = blotches + 0.3 * grain;
}

cv::Mat LensDirt::CoverOf(double dirt_share) const {
  std::vector<float> sorted(field_.begin<float>(), field_.end<float>());
  const double rank = std::clamp(1.0 - dirt_share, 0.0, 1.0) * static_cast<double>(sorted.size());
  const auto at = std::min(static_cast<std::size_t>(rank), sorted.size() - 1);
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(at), sorted.end());
  const float level = sorted[at];
  cv::Mat cover(field_.size(), CV_32FC1);
  for (int row = 0; row < field_.rows; ++row) {
    for (int col = 0; col < field_.cols; ++col) {
      const float above = (field_.at<float>(row, col) - level) / (2.0F * kEdge) + 0.5F;
      const float t = std::clamp(above, 0.0F, 1.0F);
      cover.at<float>(row, col) = t * t * (3.0F - 2.0F * t);
    }
  }
  cv::Mat full;
  cv::resize(cover, full, size_, 0.0, 0.0, cv::INTER_LINEAR);
  return full;
}

void LensDirt::Apply(double dirt_share, cv::Mat& image) {
  if (dirt_share != cover_share_) {
    cover_ = CoverOf(dirt_share);
    cover_share_ = dirt_share;
  }
  const auto glow = static_cast<float>(kGlow * cv::mean(image)[0]);
  for (int row = 0; row < image.rows; ++row) {
    auto* const pixels = image.ptr<std::uint8_t>(row);
    const auto* const cover = cover_.ptr<float>(row);
    for (int col = 0; col < image.cols; ++col) {
      const auto grey = static_cast<float>(pixels[col]);
      const float hidden = static_cast<float>(kOpacity) * cover[col];
      pixels[col] = static_cast<std::uint8_t>(std::lround(grey + hidden * (glow - grey)));
    }
  }
}

}  // namespace polnav::sim
