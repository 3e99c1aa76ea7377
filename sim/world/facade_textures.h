// What does the front of a house look like? Four bays by four storeys, or one storey of shops.
#pragma once

#include <opencv2/core/mat.hpp>

#include "sim/random.h"

namespace polnav::sim {

inline constexpr double kBay_m = 3.2;  // width of a bay, and height of a storey
inline constexpr int kBaysPerTexture = 4;

// style: 0 plaster, 1 brick, 2 stone panels, 3 concrete bands; any other repeats these.
[[nodiscard]] cv::Mat FacadeTexture(int style, RandomStream::Sample& random);  // 1024 x 1024
[[nodiscard]] cv::Mat ShopTexture(RandomStream::Sample& random);               // 256 x 1024

}  // namespace polnav::sim
