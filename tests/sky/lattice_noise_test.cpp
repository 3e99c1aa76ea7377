#include "sky/lattice_noise.h"

#include <gtest/gtest.h>

#include <cmath>

namespace polnav::sky {
namespace {

constexpr int kPlaces = 10000;

// Places far from each other in correlation lengths, and off the lattice's own grid.
Eigen::Vector2d Place(int i) { return {3.137 * (i % 100), 3.731 * (i / 100)}; }

double Product(const LatticeNoise& a, int channel_a, const LatticeNoise& b, int channel_b,
               double lag) {
  double sum = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    const Eigen::Vector2d there = Place(i) + Eigen::Vector2d(0.6 * lag, 0.8 * lag);
    sum += static_cast<double>(a.At(Place(i))[channel_a]) * b.At(there)[channel_b];
  }
  return sum / kPlaces;
}

// Neighbours at three correlation lengths: mean and deviation are known to 0.01 each, and
// tolerances are five of these.
TEST(LatticeNoise, IsCentredAndOfUnitDeviationInEveryChannel) {
  const LatticeNoise field(3);
  for (int channel = 0; channel < 4; ++channel) {
    double sum = 0.0;
    for (int i = 0; i < kPlaces; ++i) sum += field.At(Place(i))[channel];
    EXPECT_NEAR(sum / kPlaces, 0.0, 0.05);
    EXPECT_NEAR(std::sqrt(Product(field, channel, field, channel, 0.0)), 1.0, 0.05);
  }
}

// The correlation length is where it passes 1/e = 0.37.
TEST(LatticeNoise, CorrelationFallsWithLag) {
  const LatticeNoise field(7);
  const auto correlation = [&](double lag) { return Product(field, 0, field, 0, lag); };
  EXPECT_GT(correlation(0.1), 0.9);
  EXPECT_NEAR(correlation(1.0), 0.37, 0.07);
  EXPECT_LT(std::abs(correlation(10.0)), 0.05);
  EXPECT_GT(correlation(0.25), correlation(0.5));
  EXPECT_GT(correlation(0.5), correlation(1.0));
}

// Nearly independent pairs, so 5 sigma is 0.05.
TEST(LatticeNoise, ChannelsAndAdjacentSeedsShareNothing) {
  const LatticeNoise a(7);
  const LatticeNoise b(8);
  EXPECT_NEAR(Product(a, 0, b, 0, 0.0), 0.0, 0.05);
  EXPECT_NEAR(Product(a, 0, a, 1, 0.0), 0.0, 0.05);
  EXPECT_NEAR(Product(a, 2, a, 3, 0.0), 0.0, 0.05);
}

// A dense walk over many cell borders of all octaves. Each octave slopes by at most its frequency
// times its amplitude (1.9) times 5 (gradients within 1.4, and the fade's 15/8 times differences):
// five of them move it by 0.05 in a step of 0.001. A break would be of the order of 1.
TEST(LatticeNoise, IsContinuous) {
  const LatticeNoise field(7);
  NoiseChannels last = field.At({-10.0, 6.0});
  for (int i = 1; i <= 20000; ++i) {
    const NoiseChannels here = field.At({-10.0 + 0.8e-3 * i, 6.0 - 0.6e-3 * i});
    ASSERT_LT((here - last).abs().maxCoeff(), 0.05F) << i;
    last = here;
  }
}

}  // namespace
}  // namespace polnav::sky
