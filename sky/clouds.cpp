#include "sky/clouds.h"

#include <cmath>

namespace polnav::sky {

namespace {

constexpr int kOctaves = 4;
constexpr double kEarthRadius_m = 6.371e6;
constexpr double kLogShareSigma = 0.45;  // spread of the cloud's thickness, in powers of e
constexpr double kTurnSigma_rad = 0.14;  // of cloud light, lit by a patchy sky from all sides
constexpr std::uint64_t kShareField = 0x5348415245000001;
constexpr std::uint64_t kTurnField = 0x5455524E00000002;

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

// Height of the lattice point's own plane at the offset from it.
double Slope(std::int64_t ix, std::int64_t iy, double dx, double dy, std::uint64_t seed) {
  const std::uint64_t h =
      Mix(Mix(seed ^ static_cast<std::uint64_t>(ix)) ^ static_cast<std::uint64_t>(iy));
  return ToUnit(h >> 32) * dx + ToUnit(h & 0xFFFFFFFF) * dy;
}

// Quintic: two continuous derivatives across the cells.
constexpr double Fade(double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }

double GradientNoise(double x, double y, std::uint64_t seed) {
  const double fx = std::floor(x);
  const double fy = std::floor(y);
  const auto ix = static_cast<std::int64_t>(fx);
  const auto iy = static_cast<std::int64_t>(fy);
  const double dx = x - fx;
  const double dy = y - fy;
  const double south =
      std::lerp(Slope(ix, iy, dx, dy, seed), Slope(ix + 1, iy, dx - 1.0, dy, seed), Fade(dx));
  const double north = std::lerp(Slope(ix, iy + 1, dx, dy - 1.0, seed),
                                 Slope(ix + 1, iy + 1, dx - 1.0, dy - 1.0, seed), Fade(dx));
  return std::lerp(south, north, Fade(dy));
}

}  // namespace

double LatticeNoise(const Eigen::Vector2d& position, std::uint64_t seed) {
  // Of the largest octave. Its size is set for a correlation length of 1 of the whole.
  double frequency = 0.38;
  double amplitude = 4.93;
  double sum = 0.0;
  for (int octave = 0; octave < kOctaves; ++octave) {
    const std::uint64_t octave_seed = Mix(Mix(seed) + static_cast<std::uint64_t>(octave));
    // Every lattice point is a zero of its octave: shift them, or they would all meet at the
    // origin.
    const double shift_x = 64.0 * ToUnit(octave_seed >> 32);
    const double shift_y = 64.0 * ToUnit(octave_seed & 0xFFFFFFFF);
    sum += amplitude * GradientNoise(frequency * position.x() + shift_x,
                                     frequency * position.y() + shift_y, octave_seed);
    frequency *= 2.0;
    amplitude *= 0.5;
  }
  return sum;
}

CloudLight LookAtClouds(const CloudLayer& layer, const Eigen::Vector3d& ray_W,
                        const Eigen::Vector3d& observer_W, double t_s) {
  if (layer.cover <= 0.0) {
    return {};
  }
  const double rise = kEarthRadius_m * ray_W.z();
  const double distance_m =
      std::sqrt(rise * rise + layer.altitude_m * (2.0 * kEarthRadius_m + layer.altitude_m)) - rise;
  const Eigen::Vector2d place =
      (observer_W.head<2>() + distance_m * ray_W.head<2>() - layer.wind_m_s * t_s) / layer.scale_m;
  // Odds, so that cover 0 is a clear sky, cover 1 nothing but cloud, and no clipping in between.
  const double odds =
      std::exp(kLogShareSigma * LatticeNoise(place, layer.seed ^ kShareField)) * layer.cover;
  CloudLight light;
  light.share = odds / (1.0 - layer.cover + odds);
  light.turn_rad = kTurnSigma_rad * LatticeNoise(place, layer.seed ^ kTurnField);
  return light;
}

}  // namespace polnav::sky
