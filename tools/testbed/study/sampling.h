// Where in the unit cube does sample n of a study lie?
//
// One coordinate a dispersed quantity, in (0, 1). Reproducible by (seed, sample, name of the
// dimension): adding a dimension moves none of the others, except that Sobol points belong
// together.
//   random           independent
//   latin_hypercube  each of the N strata of each dimension holds exactly one of the N samples
//   sobol            Joe and Kuo's sequence [Joe2008], 64 bits, with a digital shift by the seed:
//                    all points are used, the origin too, and any first 2^k are balanced
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace polnav::testbed {

enum class Sampling { kRandom, kLatinHypercube, kSobol };

// Throws std::logic_error for a name that is none.
[[nodiscard]] Sampling ParseSampling(const std::string& name);

// Of Sobol points.
[[nodiscard]] std::size_t MaxSobolDimensions();

class UnitSampler {
 public:
  // samples: N of the Latin hypercube; the other two go on for ever.
  UnitSampler(Sampling sampling, std::uint64_t seed, std::uint64_t samples,
              std::vector<std::string> dimensions);
  ~UnitSampler();

  [[nodiscard]] std::vector<double> At(std::uint64_t sample) const;

  // Coordinates of a Sobol point without the shift, of 2^64; for tests.
  [[nodiscard]] std::vector<std::uint64_t> SobolPoint(std::uint64_t sample) const;

 private:
  struct Sobol;

  [[nodiscard]] double Independent(std::uint64_t sample, std::size_t dimension) const;

  Sampling sampling_;
  std::uint64_t seed_;
  std::uint64_t samples_;
  std::vector<std::string> dimensions_;
  std::vector<std::vector<std::uint32_t>> strata_;  // Latin hypercube: stratum of a sample
  std::vector<std::uint64_t> shifts_;
  std::unique_ptr<Sobol> sobol_;
};

}  // namespace polnav::testbed
