#include "sim/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace polnav::sim {
namespace {

using Block = std::array<std::uint32_t, 4>;

// The known answers that come with Random123 [Salmon2011], file kat_vectors.
TEST(Philox, AgreesWithTheKnownAnswers) {
  EXPECT_EQ(Philox({0, 0, 0, 0}, {0, 0}), (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  constexpr std::uint32_t kOnes = 0xffffffff;
  EXPECT_EQ(Philox({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(Philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(RandomStream, AnySampleCanBeHadWithoutTheOnesBefore) {
  const RandomStream stream(1, 2, "imu");
  std::vector<double> forwards;
  for (std::uint64_t i = 0; i < 10; ++i) {
    forwards.push_back(stream.At(i).Gaussian());
  }
  for (std::uint64_t i = 10; i-- > 0;) {
    EXPECT_EQ(RandomStream(1, 2, "imu").At(i).Gaussian(), forwards[i]);
  }
}

// Every neighbour that a study uses: 64-bit heads of 4 x 10 x 10 x 10 samples; two equal ones would
// come by chance once in 10^12 runs.
TEST(RandomStream, NeighboursShareNothing) {
  std::set<std::uint64_t> heads;
  for (const char* name : {"imu", "imu/bias", "umi", ""}) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      for (std::uint64_t trial = 0; trial < 10; ++trial) {
        for (std::uint64_t index = 0; index < 10; ++index) {
          RandomStream::Sample draw = RandomStream(seed, trial, name).At(index);
          const std::uint64_t high = draw.Bits();
          heads.insert((high << 32) | draw.Bits());
        }
      }
    }
  }
  EXPECT_EQ(heads.size(), 4000U);
}

// (seed, trial) must not act through a sum or an exclusive or.
TEST(RandomStream, SeedAndTrialAreNotInterchangeable) {
  EXPECT_NE(RandomStream(1, 2, "a").At(0).Bits(), RandomStream(2, 1, "a").At(0).Bits());
  EXPECT_NE(RandomStream(3, 0, "a").At(0).Bits(), RandomStream(0, 3, "a").At(0).Bits());
  EXPECT_NE(RandomStream(1, 1, "a").At(0).Bits(), RandomStream(0, 0, "a").At(0).Bits());
}

TEST(RandomStream, IndicesBeyond32BitsAreOthers) {
  const RandomStream stream(1, 2, "imu");
  EXPECT_NE(stream.At(5).Bits(), stream.At(5 + (1ULL << 32)).Bits());
}

constexpr int kCount = 100000;

// One draw a sample over 100000 samples: standard errors of the first four moments are
// sqrt(1, 2, 15, 96) / 316; tolerances are five of them.
TEST(RandomStream, GaussianHasTheMomentsOfOne) {
  const RandomStream stream(7, 0, "moments");
  std::array<double, 4> moment{};
  for (int i = 0; i < kCount; ++i) {
    const double x = stream.At(static_cast<std::uint64_t>(i)).Gaussian();
    moment[0] += x / kCount;
    moment[1] += x * x / kCount;
    moment[2] += x * x * x / kCount;
    moment[3] += x * x * x * x / kCount;
  }
  EXPECT_NEAR(moment[0], 0.0, 0.016);
  EXPECT_NEAR(moment[1], 1.0, 0.023);
  EXPECT_NEAR(moment[2], 0.0, 0.062);
  EXPECT_NEAR(moment[3], 3.0, 0.155);
}

// 16 equal bins: chi-square of 15 degrees of freedom passes 44 once in 10000 times.
TEST(RandomStream, UniformFillsTheUnitIntervalEvenly) {
  const RandomStream stream(7, 0, "uniform");
  std::array<int, 16> bins{};
  RandomStream::Sample draw = stream.At(0);
  for (int i = 0; i < kCount; ++i) {
    const double x = draw.Uniform();
    ASSERT_GE(x, 0.0);
    ASSERT_LT(x, 1.0);
    ++bins[static_cast<std::size_t>(16.0 * x)];
  }
  double chi2 = 0.0;
  for (const int n : bins) {
    chi2 += std::pow(n - kCount / 16.0, 2) / (kCount / 16.0);
  }
  EXPECT_LT(chi2, 44.0);
}

// Correlation of independent draws is known to 1/316; tolerance five of these.
TEST(RandomStream, NeighboursAreUncorrelated) {
  const auto correlation = [](const RandomStream& a, std::uint64_t lag, const RandomStream& b) {
    double sum = 0.0;
    for (std::uint64_t i = 0; i < kCount; ++i) {
      sum += a.At(i).Gaussian() * b.At(i + lag).Gaussian() / kCount;
    }
    return sum;
  };
  const RandomStream here(7, 0, "a");
  EXPECT_NEAR(correlation(here, 1, here), 0.0, 0.016);
  EXPECT_NEAR(correlation(here, 0, RandomStream(8, 0, "a")), 0.0, 0.016);
  EXPECT_NEAR(correlation(here, 0, RandomStream(7, 1, "a")), 0.0, 0.016);
  EXPECT_NEAR(correlation(here, 0, RandomStream(7, 0, "b")), 0.0, 0.016);
}

// Both halves of Box and Muller's pair, and the pair's halves against each other.
TEST(RandomStream, DrawsWithinASampleAreIndependent) {
  const RandomStream stream(9, 0, "pair");
  double product = 0.0;
  double squares = 0.0;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    RandomStream::Sample draw = stream.At(i);
    const double a = draw.Gaussian();
    const double b = draw.Gaussian();
    product += a * b / kCount;
    squares += (a * a - 1.0) * (b * b - 1.0) / kCount;
  }
  EXPECT_NEAR(product, 0.0, 0.016);
  EXPECT_NEAR(squares, 0.0, 0.032);  // of two chi-squares: standard error 2 / 316
}

}  // namespace
}  // namespace polnav::sim
