// Which pixel of the ideal image does each pixel behind the lens show?
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "nav/api/calibration.h"
#include "sim/render/pinhole_view.h"

namespace polnav::sim {

// How wide a nominal lens may be. A pinhole image that shows more than this is mostly border: 70
// degrees from the axis are already 2.7 focal lengths. Wider lenses would need several views.
inline constexpr double kWidestAngle_rad = 70.0 * M_PI / 180.0;

// The largest angle from the axis that a pixel of this camera looks at; not a number when the
// distortion is not monotonic that far.
[[nodiscard]] double AngleOfField(const nav::CameraCalibration& camera);

// The smallest pinhole view, at this share of the focal length, that covers all of the cameras.
// Throws std::logic_error for a camera that sees further than kWidestAngle_rad, and the three
// degrees by which a trial's lens may be wider than the nominal one.
[[nodiscard]] PinholeView CoveringView(const std::vector<nav::CameraCalibration>& cameras,
                                       double focal_share);

// Triangles [px] that cover what no camera sees of that view: the renderer need not fill them.
[[nodiscard]] std::vector<Eigen::Vector2d> UnseenTriangles(
    const std::vector<nav::CameraCalibration>& cameras, const PinholeView& view);

// Bilinear, with the source position rounded to 1/32 pixel: an error of at most 1/64 pixel an axis.
class LensWarp {
 public:
  LensWarp(const nav::CameraCalibration& camera, const PinholeView& view);
  void Apply(const cv::Mat& pinhole, cv::Mat& distorted) const;
  // Only these rows of an image that is there already.
  void ApplyToRows(const cv::Mat& pinhole, const cv::Range& rows, cv::Mat& distorted) const;

 private:
  cv::Mat whole_;     // CV_16SC2
  cv::Mat fraction_;  // CV_16UC1
};

}  // namespace polnav::sim
