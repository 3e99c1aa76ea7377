#include "sim/sensors/vignetting.h"

#include <algorithm>
#include <opencv2/core.hpp>

#include "sim/sensors/lens.h"

namespace polnav::sim {
namespace {

constexpr double kHeadroomMax = 2.0;  // coarser grey steps would show through the noise

}  // namespace

Vignetting::Vignetting(const nav::CameraCalibration& camera, double share) {
  if (share == 0.0) return;
  gain_.create(camera.height_px, camera.width_px, CV_32FC1);
  double least = 1.0;
  for (int row = 0; row < gain_.rows; ++row) {
    for (int col = 0; col < gain_.cols; ++col) {
      const double cosine2 = 1.0 / (1.0 + RayOfPixel(camera, col, row).squaredNorm());
      const double gain = 1.0 - share + share * cosine2 * cosine2;
      gain_.at<float>(row, col) = static_cast<float>(gain);
      least = std::min(least, gain);
    }
  }
  headroom_ = std::min(1.0 / least, kHeadroomMax);
  gain_ *= headroom_;
}

void Vignetting::Apply(cv::Mat& image) const {
  if (gain_.empty()) return;
  cv::multiply(image, gain_, image, 1.0, CV_8U);
}

}  // namespace polnav::sim
