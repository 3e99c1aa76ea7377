#include "sim/world/texture_noise.h"

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace polnav::sim {
namespace {

constexpr double kDeviation = 0.35;

// A lattice of cells x cells random values, enlarged to the side; periodic because its border
// repeats the opposite one.
cv::Mat Octave(int side_px, int cells, RandomStream::Sample& random) {
  cv::Mat lattice(cells, cells, CV_32FC1);
  for (int row = 0; row < cells; ++row) {
    for (int col = 0; col < cells; ++col) {
      lattice.at<float>(row, col) = static_cast<float>(random.Bits()) * 0x1p-31F - 1.0F;
    }
  }
  if (cells >= side_px) return lattice;
  constexpr int kBorder = 2;  // what cubic interpolation reaches
  cv::Mat bordered;
  cv::copyMakeBorder(lattice, bordered, kBorder, kBorder, kBorder, kBorder, cv::BORDER_WRAP);
  const int scale = side_px / cells;
  cv::Mat enlarged;
  cv::resize(bordered, enlarged, {}, scale, scale, cv::INTER_CUBIC);
  return enlarged(cv::Rect(kBorder * scale, kBorder * scale, side_px, side_px));
}

}  // namespace

cv::Mat FractalNoise(int side_px, const Octaves& octaves, RandomStream::Sample& random) {
  cv::Mat sum = cv::Mat::zeros(side_px, side_px, CV_32FC1);
  double amplitude = 1.0;
  double variance = 0.0;
  for (int k = octaves.first; k <= octaves.last && (1 << k) <= side_px; ++k) {
    cv::scaleAdd(Octave(side_px, 1 << k, random), amplitude, sum, sum);
    variance += amplitude * amplitude / 3.0 * 0.6;  // uniform on [-1, 1], smoothed
    amplitude *= octaves.persistence;
  }
  sum *= kDeviation / std::sqrt(variance);
  return sum;
}

double GroundNoise::Lattice(std::int64_t i, std::int64_t j) const {
  const auto word =
      Philox({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), 0, 0},
             {static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32)})[0];
  return static_cast<double>(word) * 0x1p-31 - 1.0;
}

double GroundNoise::At(double x_m, double y_m) const {
  const double x = x_m / scale_m_;
  const double y = y_m / scale_m_;
  const auto i = static_cast<std::int64_t>(std::floor(x));
  const auto j = static_cast<std::int64_t>(std::floor(y));
  const double u = x - std::floor(x);
  const double v = y - std::floor(y);
  return (1.0 - v) * ((1.0 - u) * Lattice(i, j) + u * Lattice(i + 1, j)) +
         v * ((1.0 - u) * Lattice(i, j + 1) + u * Lattice(i + 1, j + 1));
}

}  // namespace polnav::sim
