#include "tools/testbed/statistics/resamples.h"

#include <stdexcept>

#include "sim/random.h"

namespace polnav::testbed {

Resamples::Resamples(std::size_t n, std::size_t count, std::uint64_t seed) : n_(n), count_(count) {
  if (n == 0 || n > 65536) throw std::logic_error("resamples of 1 to 65536 values");
  indices_.reserve(n * count);
  const sim::RandomStream stream(seed, n, "statistics.resamples");
  for (std::size_t b = 0; b < count; ++b) {
    sim::RandomStream::Sample sample = stream.At(b);
    // 32 bits times n, the upper half: off from uniform by at most n / 2^32.
    for (std::size_t i = 0; i < n; ++i) {
      indices_.push_back(static_cast<std::uint16_t>((std::uint64_t{sample.Bits()} * n) >> 32U));
    }
  }
}

}  // namespace polnav::testbed
