// What do the plaza's surfaces look like from close by?
//
// Linear reflectance, 255 is white. All tile. Row 0 of a facade is its top.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "sim/random.h"

namespace polnav::sim {

using Sample = RandomStream::Sample;

// Across (columns): the road from its right edge to its left one. Along (rows): one tile of road.
// base: FractalNoise that all variants share, so that one continues the other.
[[nodiscard]] cv::Mat RoadTexture(const cv::Mat& base, bool with_crossing, Sample& random);
[[nodiscard]] cv::Mat PavingTexture(int slabs, double contrast, Sample& random);
[[nodiscard]] cv::Mat GrassTexture(Sample& random);
[[nodiscard]] cv::Mat FoliageTexture(Sample& random);
[[nodiscard]] cv::Mat BarkTexture(Sample& random);
// Plain material: concrete, roof, paint. mean: reflectance in grey levels.
[[nodiscard]] cv::Mat PlainTexture(int side_px, double mean, double contrast, Sample& random);

}  // namespace polnav::sim
