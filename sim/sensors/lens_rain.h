// What do drops on the lens do to the picture?
//
// A drop is a small wide lens: it shows its surroundings upside down, out of focus, with a dark
// rim. Each lasts 0.8 to 2 s, then another falls elsewhere; so many that they cover `rain_share` of
// the lens on average. Where they are depends on the stamp alone. More rain adds drops to those
// that are there.
#pragma once

#include <opencv2/core/mat.hpp>

#include "nav/api/time.h"
#include "sim/random.h"

namespace polnav::sim {

class LensRain {
 public:
  explicit LensRain(const RandomStream& stream) : stream_(stream) {}

  // image: CV_8UC1.
  void Apply(double rain_share, nav::TimeNs stamp, cv::Mat& image) const;

 private:
  RandomStream stream_;
};

}  // namespace polnav::sim
