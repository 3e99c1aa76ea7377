// Quantiles against closed forms and against what they must add up to.
#include "tools/testbed/study/distributions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace polnav::testbed {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double Cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

TEST(Distributions, NormalQuantilesInvertTheCdfIntoBothTails) {
  EXPECT_NEAR(NormalQuantile(0.5, 3.0, 2.0), 3.0, 1e-15);
  // The textbook's 97.5 %.
  EXPECT_NEAR(NormalQuantile(0.975, 0.0, 1.0), 1.959963984540054, 1e-13);
  for (const double u : {1e-12, 1e-6, 0.01, 0.3, 0.7, 0.99}) {
    EXPECT_NEAR(Cdf(NormalQuantile(u, 0.0, 1.0)) / u, 1.0, 1e-9) << u;
  }
}

TEST(Distributions, MomentsOfTheNormalAreItsOwn) {
  // Midpoint sums over 1e5 strata; what is cut off beyond 4.4 sigma is below 1e-3 of the variance.
  const int n = 100'000;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < n; ++i) {
    const double x = NormalQuantile((i + 0.5) / n, 2.0, 3.0);
    sum += x;
    squares += (x - 2.0) * (x - 2.0);
  }
  EXPECT_NEAR(sum / n, 2.0, 1e-9);
  EXPECT_NEAR(squares / n, 9.0, 9e-3);
}

TEST(Distributions, ATruncatedNormalKeepsItsShapeInside) {
  // P(X < x | a < X < b) by the CDF of the whole one.
  const double below = Cdf(-1.0);
  const double inside = Cdf(2.0) - below;
  for (const double u : {1e-9, 0.1, 0.5, 0.9, 1.0 - 1e-9}) {
    const double x = TruncatedNormalQuantile(u, 10.0, 2.0, 8.0, 14.0);
    EXPECT_NEAR((Cdf((x - 10.0) / 2.0) - below) / inside, u, 1e-12);
    EXPECT_GE(x, 8.0);
    EXPECT_LE(x, 14.0);
  }
}

TEST(Distributions, TruncationReachesFarIntoEitherTail) {
  // Beyond z the normal falls off as exp(-z x): the conditional median is z + ln 2 / z to first
  // order, and the next term is of order 1 / z^3.
  const double far = 12.0;
  const double upper = TruncatedNormalQuantile(0.5, 0.0, 1.0, far, kInfinity);
  EXPECT_NEAR(upper, far + std::numbers::ln2 / far, 2.0 / (far * far * far));
  EXPECT_NEAR(TruncatedNormalQuantile(0.5, 0.0, 1.0, -kInfinity, -far), -upper, 1e-12);
}

TEST(Distributions, TheMedianOfALogUniformIsTheGeometricMean) {
  EXPECT_NEAR(LogUniformQuantile(0.5, 0.01, 100.0), 1.0, 1e-12);
  EXPECT_NEAR(LogUniformQuantile(0.25, 1.0, 16.0), 2.0, 1e-12);
  EXPECT_NEAR(UniformQuantile(0.25, -2.0, 2.0), -1.0, 1e-15);
}

TEST(Distributions, DiscreteValuesComeByTheirWeights) {
  EXPECT_EQ(DiscreteQuantile(0.0, 4, {}), 0U);
  EXPECT_EQ(DiscreteQuantile(0.999999, 4, {}), 3U);
  const std::vector<double> weights{1.0, 0.0, 3.0};
  EXPECT_EQ(DiscreteQuantile(0.2499, 3, weights), 0U);
  EXPECT_EQ(DiscreteQuantile(0.2501, 3, weights), 2U);
  EXPECT_EQ(DiscreteQuantile(std::nextafter(1.0, 0.0), 3, {1.0, 1.0, 0.0}), 1U)
      << "what has no weight never comes";
}

TEST(Distributions, ACovarianceIsSymmetricAndPositiveDefinite) {
  Eigen::Matrix2d good;
  good << 4.0, 2.0, 2.0, 3.0;
  const auto factor = CholeskyFactor(good);
  ASSERT_TRUE(factor.has_value());
  EXPECT_TRUE((*factor * factor->transpose()).isApprox(good, 1e-14));
  Eigen::Matrix2d indefinite;
  indefinite << 1.0, 2.0, 2.0, 1.0;
  EXPECT_FALSE(CholeskyFactor(indefinite).has_value());
  Eigen::Matrix2d lopsided;
  lopsided << 1.0, 0.5, 0.2, 1.0;
  EXPECT_FALSE(CholeskyFactor(lopsided).has_value());
}

}  // namespace
}  // namespace polnav::testbed
