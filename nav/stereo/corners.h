// Which places of an image can be followed?
//
// Where the smaller eigenvalue of the grey slopes' covariance over a patch is large [Shi1994]:
// contrast in both directions. Found at half size, whose slopes the pyramid already holds: what can
// only be seen at full size is mostly noise, and a patch does not mind a pixel's difference.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "nav/stereo/options.h"
#include "nav/stereo/patch_flow.h"

namespace polnav::nav {

// New corners [px], strongest first: the strongest of each cell of the grid, which fill up what the
// points already followed leave empty. pyramid: with slopes.
[[nodiscard]] std::vector<cv::Point2f> FindCorners(const Pyramid& pyramid,
                                                   const std::vector<cv::Point2f>& followed,
                                                   const TrackerOptions& options);

// The smaller eigenvalue at every pixel, over squares of (2 half + 1) pixels, from the slopes in x
// and y (CV_16SC2); CV_32FC1, zero at the border.
[[nodiscard]] cv::Mat SmallerEigenvalue(const cv::Mat& slopes, int half);

}  // namespace polnav::nav
