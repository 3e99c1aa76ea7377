#include "sky/lattice_noise.h"

namespace polnav::sky {

namespace {

// Of the largest octave, set for a correlation length and a standard deviation of 1 of the whole.
constexpr double kFrequency = 0.38;
constexpr float kAmplitude = 4.90F;

// Finalizer of SplitMix64: every input bit reaches every output bit.
constexpr std::uint64_t Mix(std::uint64_t h) {
  h += 0x9E3779B97F4A7C15;
  h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9;
  h = (h ^ (h >> 27)) * 0x94D049BB133111EB;
  return h ^ (h >> 31);
}

constexpr double ToUnit(std::uint64_t bits32) {  // [-1, 1)
  return static_cast<double>(bits32) * 0x1.0p-31 - 1.0;
}

// Of the plane that each channel has at a lattice point: a lattice point draws one of 256 rows.
struct alignas(16) Gradient {
  std::array<float, 4> x;
  std::array<float, 4> y;
};
constexpr std::array<Gradient, 256> MakeGradients() {
  std::array<Gradient, 256> rows{};
  std::uint64_t count = 0;
  for (Gradient& row : rows) {
    for (std::size_t channel = 0; channel < 4; ++channel) {
      const std::uint64_t h = Mix(count++);
      row.x[channel] = static_cast<float>(ToUnit(h >> 32));
      row.y[channel] = static_cast<float>(ToUnit(h & 0xFFFFFFFF));
    }
  }
  return rows;
}
constexpr std::array<Gradient, 256> kGradients = MakeGradients();

// Multipliers that spread neighbouring lattice points over all bits.
constexpr std::uint64_t kHashX = 0x9E3779B97F4A7C15;
constexpr std::uint64_t kHashY = 0xC2B2AE3D27D4EB4F;

// Height of the lattice point's own planes at the offset from it.
inline NoiseChannels Height(std::uint64_t hash, float dx, float dy) {
  hash = (hash ^ (hash >> 32)) * 0xD6E8FEB86659FD93;
  hash ^= hash >> 29;
  const Gradient& row = kGradients[(hash * 0x94D049BB133111EB) >> 56];
  return Eigen::Map<const NoiseChannels, Eigen::Aligned16>(row.x.data()) * dx +
         Eigen::Map<const NoiseChannels, Eigen::Aligned16>(row.y.data()) * dy;
}

// Quintic: two continuous derivatives across the cells.
constexpr float Fade(float t) { return t * t * t * (t * (t * 6.0F - 15.0F) + 10.0F); }

// std::floor is a call into the library on processors of 2004.
inline std::int64_t Floor(double x) {
  const auto truncated = static_cast<std::int64_t>(x);
  return truncated - (x < static_cast<double>(truncated) ? 1 : 0);
}

NoiseChannels GradientNoise(double x, double y, std::uint64_t seed) {
  const std::int64_t west = Floor(x);
  const std::int64_t south = Floor(y);
  const auto dx = static_cast<float>(x - static_cast<double>(west));
  const auto dy = static_cast<float>(y - static_cast<double>(south));
  const std::uint64_t w = seed + static_cast<std::uint64_t>(west) * kHashX;
  const std::uint64_t s = static_cast<std::uint64_t>(south) * kHashY;
  const float fade = Fade(dx);
  const NoiseChannels sw = Height(w ^ s, dx, dy);
  const NoiseChannels se = Height((w + kHashX) ^ s, dx - 1.0F, dy);
  const NoiseChannels nw = Height(w ^ (s + kHashY), dx, dy - 1.0F);
  const NoiseChannels ne = Height((w + kHashX) ^ (s + kHashY), dx - 1.0F, dy - 1.0F);
  const NoiseChannels on_south = sw + fade * (se - sw);
  const NoiseChannels on_north = nw + fade * (ne - nw);
  return on_south + Fade(dy) * (on_north - on_south);
}

}  // namespace

LatticeNoise::LatticeNoise(std::uint64_t seed) {
  std::uint64_t state = seed;
  for (Octave& octave : octaves_) {
    state = Mix(state);
    // Every lattice point is a zero of its octave: shift them, or they would all meet at the
    // origin.
    octave = {state, {64.0 * ToUnit(state >> 32), 64.0 * ToUnit(state & 0xFFFFFFFF)}};
  }
}

NoiseChannels LatticeNoise::At(const Eigen::Vector2d& position) const {
  double frequency = kFrequency;
  float amplitude = kAmplitude;
  NoiseChannels sum = NoiseChannels::Zero();
  for (const Octave& octave : octaves_) {
    const double x = frequency * position.x() + octave.shift.x();
    const double y = frequency * position.y() + octave.shift.y();
    sum += amplitude * GradientNoise(x, y, octave.seed);
    frequency *= 2.0;
    amplitude *= 0.5F;
  }
  return sum;
}

}  // namespace polnav::sky
