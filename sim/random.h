// Where do the random numbers come from?
//
// A counter-based generator (Philox4x32-10 [Salmon2011]) keyed by (seed, trial, stream name) and
// indexed by sample: adding a stream leaves all others byte-identical, any sample can be had
// without the ones before it, and adjacent seeds share nothing.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace polnav::sim {

// The raw bijection: 10 rounds.
[[nodiscard]] std::array<std::uint32_t, 4> Philox(std::array<std::uint32_t, 4> counter,
                                                  std::array<std::uint32_t, 2> key);

class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint64_t trial, std::string_view name);

  // A generator for one sample of the stream; draws within the sample are counted inside it.
  class Sample {
   public:
    [[nodiscard]] std::uint32_t Bits();  // 32 random bits
    [[nodiscard]] double Uniform();      // [0, 1), 53 bits
    [[nodiscard]] double Gaussian();     // mean 0, sigma 1

   private:
    friend class RandomStream;
    Sample(std::array<std::uint32_t, 2> key, std::uint64_t index, std::uint32_t trial_tag);
    void Refill();

    std::array<std::uint32_t, 2> key_;
    std::array<std::uint32_t, 4> counter_;
    std::array<std::uint32_t, 4> block_{};
    int used_ = 4;
    double spare_ = 0.0;
    bool has_spare_ = false;
  };

  [[nodiscard]] Sample At(std::uint64_t index) const;

 private:
  std::array<std::uint32_t, 2> key_;
  std::uint32_t trial_tag_;
};

}  // namespace polnav::sim
