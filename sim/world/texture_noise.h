// What makes a grey surface worth looking at: detail at every scale.
//
// Tiles: the left edge continues the right one, the top the bottom. Values are roughly -1 to 1.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "sim/random.h"

namespace polnav::sim {

// Sum of octaves of smoothed random lattices. The octave k has 2^k cells across the tile; each
// next one has `persistence` times the amplitude. Scaled to a standard deviation of 0.35.
struct Octaves {
  int first = 2;
  int last = 9;
  double persistence = 0.8;
};
[[nodiscard]] cv::Mat FractalNoise(int side_px, const Octaves& octaves,
                                   RandomStream::Sample& random);  // CV_32FC1

// A smooth random field over the plane [m]: what no tile repeats. Standard deviation about 0.3.
class GroundNoise {
 public:
  GroundNoise(std::uint64_t seed, double scale_m) : seed_(seed), scale_m_(scale_m) {}
  [[nodiscard]] double At(double x_m, double y_m) const;

 private:
  [[nodiscard]] double Lattice(std::int64_t i, std::int64_t j) const;

  std::uint64_t seed_;
  double scale_m_;
};

}  // namespace polnav::sim
