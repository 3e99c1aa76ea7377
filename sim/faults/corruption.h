// What is left of a picture that came through a bad cable, driver or codec?
#pragma once

#include <opencv2/core/mat.hpp>

#include "sim/faults/fault_options.h"
#include "sim/random.h"

namespace polnav::sim {

// CV_8UC1 or CV_16UC1, which keeps to full_scale; the original is left alone.
[[nodiscard]] cv::Mat Corrupted(const CorruptFault& fault, double full_scale, const cv::Mat& image,
                                RandomStream::Sample& draw);

}  // namespace polnav::sim
