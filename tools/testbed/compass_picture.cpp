#include "tools/testbed/compass_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace polnav::testbed {
namespace {

constexpr int kPanelWidth_px = 480;
constexpr double kWhiteDop = 0.6;

// OpenCV's HSV of 8 bits: hue in half degrees, so that an axis of pi goes round once.
cv::Mat Hues(const nav::CompassTrace& trace) {
  cv::Mat hsv(trace.rows, trace.cols, CV_8UC3, cv::Scalar(0, 0, 0));
  for (int i = 0; i < trace.rows * trace.cols; ++i) {
    const nav::StokesBlock& block = trace.blocks[static_cast<std::size_t>(i)];
    if (block.intensity <= 0.0F) continue;
    const double angle = 0.5 * std::atan2(block.u, block.q);
    const int hue = static_cast<int>(std::lround(nav::RadToDeg(angle) + 180.0)) % 180;
    hsv.at<cv::Vec3b>(i / trace.cols, i % trace.cols) = {static_cast<uchar>(hue), 255, 230};
  }
  cv::Mat bgr;
  cv::cvtColor(hsv, bgr, cv::COLOR_HSV2BGR);
  return bgr;
}

cv::Mat Degrees(const nav::CompassTrace& trace) {
  cv::Mat grey(trace.rows, trace.cols, CV_8UC3, cv::Scalar(0, 0, 0));
  for (int i = 0; i < trace.rows * trace.cols; ++i) {
    const nav::StokesBlock& block = trace.blocks[static_cast<std::size_t>(i)];
    const double dop = std::min(1.0, std::hypot(block.q, block.u) / kWhiteDop);
    const auto value = static_cast<uchar>(std::lround(255.0 * dop));
    grey.at<cv::Vec3b>(i / trace.cols, i % trace.cols) = {value, value, value};
  }
  return grey;
}

cv::Mat Weights(const nav::CompassTrace& trace) {
  cv::Mat picture(trace.rows, trace.cols, CV_8UC3);
  for (int i = 0; i < trace.rows * trace.cols; ++i) {
    const float weight = trace.weight[static_cast<std::size_t>(i)];
    const auto green = static_cast<uchar>(std::lround(255.0F * std::sqrt(weight)));
    picture.at<cv::Vec3b>(i / trace.cols, i % trace.cols) =
        weight > 0.0F ? cv::Vec3b(0, green, 0) : cv::Vec3b(0, 0, 70);
  }
  return picture;
}

}  // namespace

cv::Mat CompassPicture(const nav::CompassTrace& trace, const nav::CompassReading& reading,
                       const nav::PolarizationCameraCalibration& calibration) {
  const double scale = static_cast<double>(kPanelWidth_px) / calibration.width_px;
  const cv::Size size(kPanelWidth_px, static_cast<int>(std::lround(scale * calibration.height_px)));
  const cv::Point2d center(scale * calibration.lens.center_px.x(),
                           scale * calibration.lens.center_px.y());
  const cv::Point2d along(std::cos(reading.axis_rad), std::sin(reading.axis_rad));
  const double reach = 0.45 * std::min(size.width, size.height);
  cv::Mat picture;
  for (const cv::Mat& blocks : {Hues(trace), Degrees(trace), Weights(trace)}) {
    cv::Mat panel;
    cv::resize(blocks, panel, size, 0.0, 0.0, cv::INTER_NEAREST);
    if (reading.status != nav::CompassStatus::kNone) {
      cv::line(panel, center - reach * along, center + reach * along, {255, 255, 255}, 2,
               cv::LINE_AA);
    }
    cv::copyMakeBorder(panel, panel, 4, 4, 4, 4, cv::BORDER_CONSTANT, {40, 40, 40});
    picture.empty() ? void(picture = panel) : cv::hconcat(picture, panel, picture);
  }
  return picture;
}

}  // namespace polnav::testbed
