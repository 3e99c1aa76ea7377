#include "sim/sensors/feature_conditions.h"

#include <cmath>
#include <cstdint>

namespace polnav::sim {
namespace {

constexpr double kSquare_px = 24.0;
constexpr double kKoschmieder = 3.912;  // -ln 2 %

double SignalOverNoise(double electrons, double read_noise_e) {
  return electrons / std::sqrt(electrons + read_noise_e * read_noise_e + 1e-9);
}

double ContrastAnywhere(const CameraConditions& conditions, const StereoCameraOptions& options) {
  const double electrons = options.full_well_e * options.target_mean / 255.0;
  const double dark = SignalOverNoise(conditions.light_share * electrons, options.read_noise_e) /
                      SignalOverNoise(electrons, options.read_noise_e);
  return dark / (1.0 + conditions.glare);
}

}  // namespace

FeatureConditions::FeatureConditions(const CameraConditions& conditions,
                                     const StereoCameraOptions& options,
                                     const RandomStream& cover_stream, nav::TimeNs stamp)
    : conditions_(conditions),
      cover_stream_(cover_stream),
      second_(static_cast<std::uint64_t>(stamp / nav::kNsPerSecond)),
      contrast_share_(ContrastAnywhere(conditions, options)),
      brightest_(255.0 / (2.0 * options.target_mean * conditions.gain_share)) {}

double FeatureConditions::ContrastShare(double distance_m) const {
  if (std::isinf(conditions_.visibility_m)) return contrast_share_;
  return contrast_share_ * std::exp(-kKoschmieder * distance_m / conditions_.visibility_m);
}

bool FeatureConditions::IsCovered(int eye, const Eigen::Vector2d& pixel) const {
  if (conditions_.dirt_share == 0.0 && conditions_.rain_share == 0.0) return false;
  const auto column = static_cast<std::uint64_t>(std::max(0.0, pixel.x()) / kSquare_px);
  const auto row = static_cast<std::uint64_t>(std::max(0.0, pixel.y()) / kSquare_px);
  const std::uint64_t square = (row * 256 + column) * 2 + static_cast<std::uint64_t>(eye);
  // Sample 0 of a square is its dirt, the others its drops.
  const auto hit = [&](std::uint64_t index, double share) {
    return share > 0.0 && cover_stream_.At(square << 32U | index).Uniform() < share;
  };
  return hit(0, conditions_.dirt_share) || hit(1 + second_, conditions_.rain_share);
}

}  // namespace polnav::sim
