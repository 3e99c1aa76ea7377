#include "sim/sensors/pixel_noise.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "sim/random.h"

namespace polnav::sim {
namespace {

constexpr int kFractionBits = 16;
constexpr std::int32_t kSumMean = 510;  // of four bytes

// Sums of the four bytes of one hashed counter a pixel. Philox, which all other streams use, would
// take as long as the rendering; a finalizer with full avalanche is enough for pixel noise.
void SumOfBytes(std::array<std::uint32_t, 2> key, std::uint32_t first, int count,
                std::int32_t* sums) {
  for (int i = 0; i < count; ++i) {
    std::uint32_t x = (first + static_cast<std::uint32_t>(i)) * 0x9E3779B9U + key[0];
    x = (x ^ (x >> 16)) * 0x7FEB352DU ^ key[1];
    x = (x ^ (x >> 15)) * 0x846CA68BU;
    x ^= x >> 16;
    const std::uint32_t pairs = (x & 0x00FF00FFU) + ((x >> 8) & 0x00FF00FFU);
    sums[i] = static_cast<std::int32_t>((pairs & 0xFFFFU) + (pairs >> 16)) - kSumMean;
  }
}

}  // namespace

PixelNoise::PixelNoise(double full_well_e, double read_noise_e) {
  const double sum_sigma = std::sqrt(4.0 * (256.0 * 256.0 - 1.0) / 12.0);
  for (std::size_t grey = 0; grey < scale_.size(); ++grey) {
    const double electrons = full_well_e * static_cast<double>(grey) / 255.0;
    const double sigma_e = std::sqrt(electrons + read_noise_e * read_noise_e);
    const double sigma = sigma_e * 255.0 / full_well_e;
    // At a sigma of 60 grey levels the product below would leave 31 bits.
    const double bounded = std::min(sigma, 60.0) / sum_sigma;
    scale_[grey] = static_cast<std::int32_t>(std::lround(bounded * (1 << kFractionBits)));
  }
}

void PixelNoise::Add(std::array<std::uint32_t, 2> key, cv::Mat& image) const {
  if (image.type() != CV_8UC1) throw std::logic_error("pixel noise needs CV_8UC1");
  // Keys that differ in one bit must not give related noise.
  const auto mixed = Philox({}, key);
  std::vector<std::int32_t> sums(static_cast<std::size_t>(image.cols));
  for (int row = 0; row < image.rows; ++row) {
    SumOfBytes({mixed[0], mixed[1]}, static_cast<std::uint32_t>(row * image.cols), image.cols,
               sums.data());
    std::uint8_t* const pixels = image.ptr<std::uint8_t>(row);
    for (int col = 0; col < image.cols; ++col) {
      const std::int32_t grey = pixels[col];
      const std::int32_t noisy = (grey << kFractionBits) + scale_[static_cast<std::size_t>(grey)] *
                                                               sums[static_cast<std::size_t>(col)];
      const std::int32_t rounded = (noisy + (1 << (kFractionBits - 1))) >> kFractionBits;
      pixels[col] = static_cast<std::uint8_t>(std::clamp(rounded, 0, 255));
    }
  }
}

}  // namespace polnav::sim
