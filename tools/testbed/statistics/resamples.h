// Which trials does each bootstrap resample draw?
//
// n indices with replacement, `count` times, from Philox keyed by the seed, n and the resample:
// equal for all metrics of n trials, so that a metric's interval does not depend on which others
// are asked for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace polnav::testbed {

class Resamples {
 public:
  // n: 1 to 65536.
  Resamples(std::size_t n, std::size_t count, std::uint64_t seed);

  [[nodiscard]] std::size_t size() const { return n_; }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::span<const std::uint16_t> At(std::size_t resample) const {
    return {indices_.data() + resample * n_, n_};
  }

 private:
  std::size_t n_;
  std::size_t count_;
  std::vector<std::uint16_t> indices_;
};

}  // namespace polnav::testbed
