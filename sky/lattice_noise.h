// What is the value of a smooth random field at this place?
//
// Four channels that share a lattice but nothing else, each of mean 0, standard deviation 1 and
// correlation length 1 (where the correlation passes 1/e): gradient noise of five octaves, each
// half the size and half the amplitude of the one before, on an integer lattice with a hash of its
// own, so that the same seed is the same field everywhere. Two continuous derivatives.
// Where it fails: nearly but not quite Gaussian (a share of 0.1 lies above 1.294, not 1.282), and
// bounded near 5; no structure below a sixteenth of the largest octave; rounded to 1e-6, and lost
// in rounding beyond 1e9 lengths from the origin.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace polnav::sky {

using NoiseChannels = Eigen::Array4f;

class LatticeNoise {
 public:
  explicit LatticeNoise(std::uint64_t seed);

  // position: in units of the correlation length.
  [[nodiscard]] NoiseChannels At(const Eigen::Vector2d& position) const;

 private:
  struct Octave {
    std::uint64_t seed;
    Eigen::Vector2d shift;
  };
  std::array<Octave, 5> octaves_;
};

}  // namespace polnav::sky
