// What does a dirty lens hide?
//
// Blotches, out of focus, that stay where they are: where a smooth random field is above the level
// that leaves it so on `dirt_share` of the lens. More dirt grows the same blotches. They let a
// tenth of the picture through and glow with half of its mean light.
#pragma once

#include <opencv2/core/mat.hpp>

#include "sim/random.h"

namespace polnav::sim {

class LensDirt {
 public:
  LensDirt(const cv::Size& size, const RandomStream& stream);

  // image: CV_8UC1 of that size.
  void Apply(double dirt_share, cv::Mat& image);

 private:
  [[nodiscard]] cv::Mat CoverOf(double dirt_share) const;

  cv::Size size_;
  cv::Mat field_;  // CV_32FC1, coarser than the picture, sigma 1
  double cover_share_ = -1.0;
  cv::Mat cover_;  // CV_32FC1, 0 clean to 1 hidden, for cover_share_
};

}  // namespace polnav::sim
