// Points in the unit cube: what each way of sampling promises.
#include "tools/testbed/study/sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace polnav::testbed {
namespace {

TEST(Sampling, RandomPointsAreUniformAndIndependent) {
  const UnitSampler sampler(Sampling::kRandom, 1, 0, {"a", "b"});
  const int n = 4000;
  double mean = 0.0;
  double product = 0.0;
  for (int i = 0; i < n; ++i) {
    const std::vector<double> u = sampler.At(static_cast<std::uint64_t>(i));
    mean += u[0] / n;
    product += (u[0] - 0.5) * (u[1] - 0.5) / n;
  }
  // Five sigma: a uniform number's is 1/sqrt(12), a product's 1/12.
  EXPECT_NEAR(mean, 0.5, 5.0 / std::sqrt(12.0 * n));
  EXPECT_NEAR(product, 0.0, 5.0 / (12.0 * std::sqrt(n)));
}

TEST(Sampling, ADimensionMoreLeavesTheOthersWhereTheyAre) {
  for (const Sampling sampling : {Sampling::kRandom, Sampling::kLatinHypercube}) {
    const UnitSampler one(sampling, 3, 50, {"b"});
    const UnitSampler two(sampling, 3, 50, {"a", "b"});
    for (std::uint64_t i = 0; i < 50; ++i) EXPECT_EQ(one.At(i)[0], two.At(i)[1]);
  }
}

TEST(Sampling, TheSeedDecides) {
  for (const Sampling sampling : {Sampling::kRandom, Sampling::kLatinHypercube, Sampling::kSobol}) {
    const UnitSampler a(sampling, 3, 50, {"x"});
    const UnitSampler b(sampling, 3, 50, {"x"});
    const UnitSampler c(sampling, 4, 50, {"x"});
    EXPECT_EQ(a.At(7), b.At(7));
    EXPECT_NE(a.At(7), c.At(7));
  }
}

TEST(Sampling, EachStratumOfALatinHypercubeHoldsOneSample) {
  const std::uint64_t n = 137;
  const UnitSampler sampler(Sampling::kLatinHypercube, 9, n, {"a", "b", "c"});
  std::vector<std::set<std::uint64_t>> strata(3);
  for (std::uint64_t i = 0; i < n; ++i) {
    const std::vector<double> u = sampler.At(i);
    for (std::size_t d = 0; d < 3; ++d) {
      strata[d].insert(static_cast<std::uint64_t>(u[d] * static_cast<double>(n)));
    }
  }
  for (const auto& hit : strata) EXPECT_EQ(hit.size(), n);
}

// Joe and Kuo's new-joe-kuo-6 tables, first three dimensions.
TEST(Sampling, SobolPointsAreTheKnownOnes) {
  const UnitSampler sampler(Sampling::kSobol, 1, 0, {"a", "b", "c"});
  const std::vector<std::vector<double>> known = {{0.0, 0.0, 0.0},       {0.5, 0.5, 0.5},
                                                  {0.75, 0.25, 0.25},    {0.25, 0.75, 0.75},
                                                  {0.375, 0.375, 0.625}, {0.875, 0.875, 0.125}};
  for (std::size_t i = 0; i < known.size(); ++i) {
    const std::vector<std::uint64_t> point = sampler.SobolPoint(i);
    for (std::size_t d = 0; d < 3; ++d) {
      EXPECT_EQ(static_cast<double>(point[d]) * 0x1p-64, known[i][d]) << i << " " << d;
    }
  }
}

TEST(Sampling, TheFirstPowersOfTwoOfShiftedSobolPointsAreBalanced) {
  const UnitSampler sampler(Sampling::kSobol, 12345, 0, {"a", "b", "c", "d"});
  const std::uint64_t n = 256;
  std::vector<std::set<int>> strata(4);
  std::set<int> squares;  // 16 x 16 of the first two: they form a (0, 2)-sequence
  for (std::uint64_t i = 0; i < n; ++i) {
    const std::vector<double> u = sampler.At(i);
    for (std::size_t d = 0; d < 4; ++d) strata[d].insert(static_cast<int>(u[d] * 256.0));
    squares.insert(16 * static_cast<int>(u[0] * 16.0) + static_cast<int>(u[1] * 16.0));
  }
  for (const auto& hit : strata) EXPECT_EQ(hit.size(), n);
  EXPECT_EQ(squares.size(), n);
}

}  // namespace
}  // namespace polnav::testbed
