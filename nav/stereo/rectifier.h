// Where would an ideal stereo pair have seen this pixel?
//
// Points, not images, are rectified: raw pixels of both cameras become pixels of a virtual pair of
// equal pinhole cameras whose rows coincide, so that [Chu2021, eqs 13-15] hold as printed:
//   u = f X / Z + cx,  v = f Y / Z + cy,  u_L - u_R = b f / Z.
// C is the virtual left camera; it sits where the left camera sits.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "nav/api/calibration.h"

namespace polnav::nav {

struct RectifiedCamera {
  double f_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  double baseline_m = 0.0;
  Pose T_BC;
};

class StereoRectifier {
 public:
  explicit StereoRectifier(const StereoCalibration& calibration);

  [[nodiscard]] const RectifiedCamera& camera() const { return camera_; }
  [[nodiscard]] std::vector<cv::Point2f> RectifyLeft(const std::vector<cv::Point2f>& raw) const;
  [[nodiscard]] std::vector<cv::Point2f> RectifyRight(const std::vector<cv::Point2f>& raw) const;

  // The way back: where the real right camera sees what the virtual one sees there.
  [[nodiscard]] cv::Point2f RawRight(const cv::Point2f& rectified) const;

 private:
  struct Side {
    DistortionModel model = DistortionModel::kRadTan;
    cv::Matx33d intrinsics;
    cv::Vec4d distortion;
    cv::Matx33d rotation;  // from the real camera's frame into the virtual one
  };
  [[nodiscard]] std::vector<cv::Point2f> Rectify(const Side& side,
                                                 const std::vector<cv::Point2f>& raw) const;

  RectifiedCamera camera_;
  Side left_;
  Side right_;
};

}  // namespace polnav::nav
