// What does a reading look like that is off by so much?
//
// Bias, drift and noise are the same thing with another factor: each number of a measurement is
// moved by its amount times factor(), which is called once a number in a fixed order. Readings stay
// within full scale where they have one. Pictures are copied before they are changed: others may
// hold them.
#pragma once

#include <functional>

#include "nav/api/calibration.h"
#include "nav/api/measurements.h"
#include "sim/faults/fault_options.h"

namespace polnav::sim {

void Deviate(const Amounts& amounts, const nav::Rig& rig, const std::function<double()>& factor,
             nav::Measurement& measurement);

// Adds so much noise that it is, with the sensor's own as the rig states it, `times` as large.
// normal: draws of mean 0, sigma 1. Throws std::logic_error where the rig states none.
void MultiplyNoise(double times, const nav::Rig& rig, const std::function<double()>& normal,
                   nav::Measurement& measurement);

// Of a mosaic, in its own numbers.
[[nodiscard]] double FullScale(const nav::Rig& rig, const cv::Mat& mosaic);

}  // namespace polnav::sim
