// Each statistic against what theory or a hand gives. How often intervals hold the truth is in
// coverage_test.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tools/testbed/statistics/consistency.h"
#include "tools/testbed/statistics/mean.h"
#include "tools/testbed/statistics/paired.h"
#include "tools/testbed/statistics/percentile.h"
#include "tools/testbed/statistics/rate.h"
#include "tools/testbed/statistics/sensitivity.h"
#include "tools/testbed/statistics/stopping.h"

namespace polnav::testbed {
namespace {

std::vector<double> Ramp(int n) {
  std::vector<double> values;
  for (int i = 1; i <= n; ++i) values.push_back(i);
  return values;
}

TEST(MeanInterval, OfEqualValuesIsThatValueAndOfTwoIsUnbounded) {
  const Estimated equal = MeanWithInterval(std::vector<double>(20, 0.1), 1);
  EXPECT_DOUBLE_EQ(equal.interval.HalfWidth(), 0.0);
  EXPECT_TRUE(std::isinf(MeanWithInterval(Ramp(2), 1).interval.upper));
}

TEST(MeanInterval, DependsOnTheSeedAloneAndMovesWithUnits) {
  const std::vector<double> values = Ramp(30);
  const Estimated a = MeanWithInterval(values, 1);
  EXPECT_EQ(a.interval.lower, MeanWithInterval(values, 1).interval.lower);
  EXPECT_NE(a.interval.lower, MeanWithInterval(values, 2).interval.lower);
  std::vector<double> scaled;
  for (const double v : values) scaled.push_back(10.0 - 2.0 * v);
  const Estimated b = MeanWithInterval(scaled, 1);
  EXPECT_NEAR(b.interval.lower, 10.0 - 2.0 * a.interval.upper, 1e-12);
}

// The bootstrap and the formula above kBootstrapSize agree where they meet, to the noise of 999
// resamples: a 2.5 % quantile of 999 is off by 0.1 sigma at two sigma.
TEST(MeanInterval, IsContinuousInTheNumberOfTrials) {
  const Interval below = MeanWithInterval(Ramp(300), 1).interval;
  const Interval above = MeanWithInterval(Ramp(301), 1).interval;
  EXPECT_NEAR(below.HalfWidth(), above.HalfWidth(), 0.1 * above.HalfWidth());
}

TEST(Improvement, OfAHalfIsAHalf) {
  const std::vector<double> b = Ramp(40);
  std::vector<double> a = b;
  for (double& v : a) v *= 0.5;
  const Estimated improvement = ImprovementWithInterval(a, b, 1);
  EXPECT_DOUBLE_EQ(improvement.value, 0.5);
  EXPECT_NEAR(improvement.interval.HalfWidth(), 0.0, 1e-9);
}

// Of 20 values the 6th and 15th bound the median with 95.86 %: interpolated, a little inside.
TEST(PercentileInterval, LiesJustInsideTheBinomialOneForTheMedian) {
  const Interval interval = PercentileWithInterval(Ramp(20), 50.0).interval;
  EXPECT_GE(interval.lower, 6.0);
  EXPECT_LT(interval.lower, 6.5);
  EXPECT_NEAR(interval.lower + interval.upper, 21.0, 1e-9);
}

// 1 - 0.95^n >= 0.975 from n = 72 on.
TEST(PercentileInterval, OfTheTailHasNoUpperEndBefore72Values) {
  EXPECT_TRUE(std::isinf(PercentileWithInterval(Ramp(71), 95.0).interval.upper));
  EXPECT_LE(PercentileWithInterval(Ramp(72), 95.0).interval.upper, 72.0);
  EXPECT_TRUE(std::isfinite(PercentileWithInterval(Ramp(71), 95.0).interval.lower));
}

// Wilson's interval for 15 of 20 is [0.531, 0.888]; Clopper and Pearson's [0.509, 0.913].
TEST(RateInterval, HasThePublishedNumbers) {
  const Interval wilson = RateWithInterval(15, 20).interval;
  EXPECT_NEAR(wilson.lower, 0.531, 5e-4);
  EXPECT_NEAR(wilson.upper, 0.888, 5e-4);
  const Interval exact = ExactRateInterval(15, 20);
  EXPECT_NEAR(exact.lower, 0.509, 5e-4);
  EXPECT_NEAR(exact.upper, 0.913, 5e-4);
  EXPECT_EQ(RateWithInterval(20, 20).interval.upper, 1.0);
}

// All of ten lower: 2 / 2^10. All signed ranks of five positive: 2 / 2^5.
TEST(PairedTests, AreExactForFewTrials) {
  EXPECT_DOUBLE_EQ(SignTest(10, 0), 2.0 / 1024.0);
  EXPECT_DOUBLE_EQ(SignTest(5, 5), 1.0);
  EXPECT_DOUBLE_EQ(WilcoxonTest(Ramp(5)), 2.0 / 32.0);
}

TEST(Consistency, BoundsNarrowAroundOne) {
  // chi-square of 20: 9.591 and 34.170.
  const Interval bounds = ChiSquareBounds(20, 1.0);
  EXPECT_NEAR(bounds.lower, 9.591 / 20.0, 1e-4);
  EXPECT_NEAR(bounds.upper, 34.170 / 20.0, 1e-4);
}

TEST(Sensitivity, FindsALineByRankAndAParabolaByVarianceOnly) {
  std::vector<double> x;
  std::vector<double> parabola;
  for (int i = -50; i <= 50; ++i) x.push_back(i);
  for (const double v : x) parabola.push_back(v * v);
  EXPECT_DOUBLE_EQ(RankCorrelation(x, x).value, 1.0);
  EXPECT_NEAR(RankCorrelation(x, parabola).value, 0.0, 1e-12);
  EXPECT_NEAR(FirstOrderIndex(x, parabola), 1.0, 1e-9);
}

TEST(Stopping, LooksSeldomAndIgnoresWhatRanAhead) {
  EXPECT_EQ(NextLook(0), 100U);
  EXPECT_EQ(NextLook(100), 125U);
  EXPECT_EQ(NextLook(130), 157U);
  std::vector<double> values = Ramp(1000);
  for (double& v : values) v = std::fmod(v * 0.618033988749895, 1.0);
  const LookFunction mean = [](auto v) { return MeanWithInterval(v, 1); };
  const auto stop = StopsAt(values, {.half_width = 0.05}, mean);
  ASSERT_TRUE(stop.has_value());
  EXPECT_EQ(StopsAt(std::span(values).first(*stop), {.half_width = 0.05}, mean), stop);
  EXPECT_LE(MeanWithInterval(std::span(values).first(*stop), 1).interval.HalfWidth(), 0.05);
  EXPECT_FALSE(StopsAt(values, {.half_width = 1e-6}, mean).has_value());
  const std::size_t third = NextLook(NextLook(*stop));
  EXPECT_EQ(StopsAt(values, {.half_width = 0.05, .more_looks = 2}, mean), third);
  EXPECT_EQ(LookBefore(third, 2), stop);
  EXPECT_FALSE(LookBefore(kFirstLook, 1).has_value());
  // Of a mean of 0.5: a tenth of it is the same rule.
  EXPECT_EQ(StopsAt(values, {.half_width = 0.1, .relative = true}, mean), stop);
}

}  // namespace
}  // namespace polnav::testbed
