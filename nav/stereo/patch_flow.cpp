#include "nav/stereo/patch_flow.h"

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace polnav::nav {
namespace {

using cv::TermCriteria;

// A first guess for what follows, and what tells whether a track comes back.
const TermCriteria kRoughly(TermCriteria::COUNT + TermCriteria::EPS, 12, 0.02);

std::vector<std::uint8_t> Follow(const Pyramid& from_pyramid, const Pyramid& to_pyramid,
                                 const std::vector<cv::Point2f>& from, std::vector<cv::Point2f>& to,
                                 const TrackerOptions& options, int levels) {
  std::vector<std::uint8_t> status;
  cv::calcOpticalFlowPyrLK(from_pyramid, to_pyramid, from, to, status, cv::noArray(),
                           {options.window_px, options.window_px}, levels, kRoughly,
                           cv::OPTFLOW_USE_INITIAL_FLOW);
  return status;
}

}  // namespace

Pyramid BuildPyramid(const cv::Mat& image, const TrackerOptions& options, bool with_slopes) {
  Pyramid pyramid;
  cv::Mat smooth = image;
  if (options.smoothing_px > 0.0) {
    cv::GaussianBlur(image, smooth, {5, 5}, options.smoothing_px);
  }
  cv::buildOpticalFlowPyramid(smooth, pyramid, {options.window_px, options.window_px},
                              options.pyramid_levels, with_slopes);
  return pyramid;
}

std::vector<cv::Mat> ImagesOf(const Pyramid& pyramid) {
  std::vector<cv::Mat> images;
  for (const cv::Mat& level : pyramid) {
    if (level.type() == CV_8UC1) images.push_back(level);
  }
  return images;
}

std::vector<bool> FollowBothWays(const Pyramid& from_pyramid, const Pyramid& to_pyramid,
                                 const std::vector<cv::Point2f>& from, std::vector<cv::Point2f>& to,
                                 const TrackerOptions& options) {
  std::vector<bool> ok(from.size(), false);
  if (from.empty()) return ok;
  const std::vector<std::uint8_t> status =
      Follow(from_pyramid, to_pyramid, from, to, options, options.pyramid_levels);
  // Starting the way back from the origin would hide a patch that locked onto something else; one
  // pyramid level suffices to see whether it comes back.
  std::vector<cv::Point2f> back = from;
  const std::vector<std::uint8_t> status_back =
      Follow(to_pyramid, from_pyramid, to, back, options, 1);
  const cv::Size size = to_pyramid[0].size();
  const auto limit = static_cast<float>(options.forward_backward_px);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const cv::Point2f d = back[i] - from[i];
    const bool inside =
        to[i].x >= 1 && to[i].y >= 1 && to[i].x < size.width - 2 && to[i].y < size.height - 2;
    ok[i] = status[i] != 0 && status_back[i] != 0 && inside && d.dot(d) < limit * limit;
  }
  return ok;
}

}  // namespace polnav::nav
