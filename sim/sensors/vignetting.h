// How much light is left towards the corners of a picture?
//
// 1 - share + share cos^4(angle from the axis): the natural law of a plain lens, or a share of it.
// The renderer has clipped at full scale already, where the corner's share of a brighter thing
// could still be below it: pictures are drawn darker by `headroom`, at most half, and brought back
// here.
#pragma once

#include <opencv2/core/mat.hpp>

#include "nav/api/calibration.h"

namespace polnav::sim {

class Vignetting {
 public:
  Vignetting(const nav::CameraCalibration& camera, double share);

  // By which the picture must be drawn darker than it will be; 1 without vignetting.
  [[nodiscard]] double headroom() const { return headroom_; }
  void Apply(cv::Mat& image) const;

 private:
  double headroom_ = 1.0;
  cv::Mat gain_;  // CV_32FC1, headroom included; empty without vignetting
};

}  // namespace polnav::sim
