// Where did the patches go?
//
// Lucas-Kanade over image pyramids, coarse to fine, for translation alone.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "nav/stereo/options.h"

namespace polnav::nav {

using Pyramid = std::vector<cv::Mat>;  // as cv::buildOpticalFlowPyramid makes them

// with_slopes: also the derivatives, which the image that points are followed from needs.
[[nodiscard]] Pyramid BuildPyramid(const cv::Mat& image, const TrackerOptions& options,
                                   bool with_slopes);

// Its images alone, full size first.
[[nodiscard]] std::vector<cv::Mat> ImagesOf(const Pyramid& pyramid);

// From one image to another and back; a point that does not return to within the threshold is not
// to be trusted. `to` holds the first guess on entry.
[[nodiscard]] std::vector<bool> FollowBothWays(const Pyramid& from_pyramid,
                                               const Pyramid& to_pyramid,
                                               const std::vector<cv::Point2f>& from,
                                               std::vector<cv::Point2f>& to,
                                               const TrackerOptions& options);

}  // namespace polnav::nav
