// Which pixel of the ideal image does each pixel behind the lens show?
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "nav/api/calibration.h"
#include "sim/render/pinhole_view.h"

namespace polnav::sim {

// The smallest pinhole view, at this share of the focal length, that covers all of the cameras.
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

 private:
  cv::Mat whole_;     // CV_16SC2
  cv::Mat fraction_;  // CV_16UC1
};

}  // namespace polnav::sim
