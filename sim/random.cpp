#include "sim/random.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace polnav::sim {

namespace {

using Block = std::array<std::uint32_t, 4>;
using Key = std::array<std::uint32_t, 2>;

// [Salmon2011, table 2]
constexpr std::uint32_t kMultiplier0 = 0xD2511F53;
constexpr std::uint32_t kMultiplier1 = 0xCD9E8D57;
constexpr std::uint32_t kWeyl0 = 0x9E3779B9;  // golden ratio
constexpr std::uint32_t kWeyl1 = 0xBB67AE85;  // sqrt(3) - 1
constexpr int kRounds = 10;

constexpr std::uint32_t Low(std::uint64_t x) { return static_cast<std::uint32_t>(x); }
constexpr std::uint32_t High(std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); }

constexpr Block Round(const Block& c, const Key& k) {
  const std::uint64_t p0 = static_cast<std::uint64_t>(kMultiplier0) * c[0];
  const std::uint64_t p1 = static_cast<std::uint64_t>(kMultiplier1) * c[2];
  return {High(p1) ^ c[1] ^ k[0], Low(p1), High(p0) ^ c[3] ^ k[1], Low(p0)};
}

// FNV-1a tells names apart; the finalizer of SplitMix64 spreads the difference over all bits.
constexpr std::uint64_t HashName(std::string_view name) {
  std::uint64_t h = 0xCBF29CE484222325;
  for (const char c : name) {
    h = (h ^ static_cast<unsigned char>(c)) * 0x100000001B3;
  }
  h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9;
  h = (h ^ (h >> 27)) * 0x94D049BB133111EB;
  return h ^ (h >> 31);
}

}  // namespace

std::array<std::uint32_t, 4> Philox(std::array<std::uint32_t, 4> counter,
                                    std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < kRounds; ++round) {
    counter = Round(counter, key);
    key[0] += kWeyl0;
    key[1] += kWeyl1;
  }
  return counter;
}

// One Philox call mixes the three: for a given name it is a bijection of (seed, trial), so that two
// trials or two neighbouring seeds end at unrelated places of a 96-bit space.
RandomStream::RandomStream(std::uint64_t seed, std::uint64_t trial, std::string_view name) {
  const std::uint64_t name_hash = HashName(name);
  const Block mixed =
      Philox({Low(seed), High(seed), Low(trial), High(trial)}, {Low(name_hash), High(name_hash)});
  key_ = {mixed[0], mixed[1]};
  trial_tag_ = mixed[2];
}

RandomStream::Sample RandomStream::At(std::uint64_t index) const {
  return {key_, index, trial_tag_};
}

RandomStream::Sample::Sample(std::array<std::uint32_t, 2> key, std::uint64_t index,
                             std::uint32_t trial_tag)
    : key_(key), counter_{0, Low(index), High(index), trial_tag} {}

void RandomStream::Sample::Refill() {
  block_ = Philox(counter_, key_);
  used_ = 0;
  if (++counter_[0] == 0) {
    throw std::logic_error("RandomStream: more than 2^34 draws from one sample");
  }
}

std::uint32_t RandomStream::Sample::Bits() {
  if (used_ == 4) {
    Refill();
  }
  return block_[used_++];
}

double RandomStream::Sample::Uniform() {
  const std::uint64_t high = Bits() >> 5;  // 27 bits
  const std::uint64_t low = Bits() >> 6;   // 26 bits
  return static_cast<double>((high << 26) | low) * 0x1.0p-53;
}

// Box and Muller: two draws a pair, no rejection, so the count of draws never depends on values.
double RandomStream::Sample::Gaussian() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2.0 * std::log(1.0 - Uniform()));  // 1 - u is never zero
  const double angle = 2.0 * std::numbers::pi * Uniform();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

}  // namespace polnav::sim
