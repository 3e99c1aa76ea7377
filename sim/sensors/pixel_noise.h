// What do photons and electronics add to a pixel?
//
// Shot noise, whose variance is the number of electrons, and read noise: a grey value g has
//   sigma^2 = (g / 255 full_well + read_noise^2) (255 / full_well)^2.
// Approximately Gaussian (the sum of four uniform bytes: no tail beyond 3.4 sigma). Then rounded.
// Where black or white clips, the mean shifts as it does in a camera.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace polnav::sim {

class PixelNoise {
 public:
  PixelNoise(double full_well_e, double read_noise_e);

  // image: CV_8UC1. The noise of a pixel depends on the key and the pixel's place alone.
  void Add(std::array<std::uint32_t, 2> key, cv::Mat& image) const;

 private:
  std::array<std::int32_t, 256> scale_{};  // by grey level, fixed point
};

}  // namespace polnav::sim
