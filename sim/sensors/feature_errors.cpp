#include "sim/sensors/feature_errors.h"

#include <cmath>
#include <numbers>

namespace polnav::sim {

using Eigen::Vector2d;
using Sample = RandomStream::Sample;

namespace {

Vector2d Gaussian2(double sigma, Sample& draw) {
  const double x = draw.Gaussian();
  return sigma * Vector2d(x, draw.Gaussian());
}

// Now and then, anywhere in a disc.
Vector2d Jump(const FeatureOptions& options, Sample& draw) {
  const bool jumps = draw.Uniform() < options.outlier_share;
  const double radius = options.outlier_px * std::sqrt(draw.Uniform());
  const double angle = 2.0 * std::numbers::pi * draw.Uniform();
  if (!jumps) return Vector2d::Zero();
  return radius * Vector2d(std::cos(angle), std::sin(angle));
}

}  // namespace

TrackErrors DrawTrackErrors(const FeatureOptions& options, Sample draw) {
  TrackErrors errors{.patch_px = Gaussian2(options.patch_sigma_px, draw)};
  if (draw.Uniform() < options.false_match_share) {
    errors.false_match_px = options.outlier_px * (2.0 * draw.Uniform() - 1.0);
  }
  return errors;
}

SightingErrors DrawSightingErrors(const FeatureOptions& options, Sample& draw) {
  const Vector2d place = Gaussian2(options.pixel_sigma_px, draw);
  const Vector2d match = Gaussian2(options.match_sigma_px, draw);
  const Vector2d left_jump = Jump(options, draw);
  const Vector2d right_jump = Jump(options, draw);
  return {place + left_jump, place + match + right_jump,
          draw.Uniform() < options.right_loss_probability};
}

Descriptor DescriptorOf(Sample own, int flipped_bits, Sample& flips) {
  Descriptor descriptor{};
  for (std::size_t i = 0; i < descriptor.size(); i += 4) {
    const std::uint32_t bits = own.Bits();
    for (std::size_t k = 0; k < 4; ++k) {
      descriptor[i + k] = static_cast<std::uint8_t>(bits >> (8 * k));
    }
  }
  std::uint32_t bits = 0;
  for (int i = 0; i < flipped_bits; ++i) {
    bits = i % 4 == 0 ? flips.Bits() : bits >> 8U;
    const std::uint32_t at = bits & 255U;
    descriptor[at / 8U] ^= static_cast<std::uint8_t>(1U << (at % 8U));
  }
  return descriptor;
}

}  // namespace polnav::sim
