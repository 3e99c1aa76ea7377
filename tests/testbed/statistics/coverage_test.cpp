// Intervals of so many trials; see coverage.h.
#include "tests/testbed/statistics/coverage.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "sim/random.h"
#include "tools/testbed/statistics/consistency.h"
#include "tools/testbed/statistics/mean.h"
#include "tools/testbed/statistics/paired.h"
#include "tools/testbed/statistics/percentile.h"
#include "tools/testbed/statistics/rate.h"
#include "tools/testbed/statistics/sensitivity.h"

namespace polnav::testbed {
namespace {

TEST(Coverage, OfTheMean) {
  for (const Metric& m : Metrics()) {
    for (const int n : {20, 50, 200, 1000}) {
      const std::string what = fmt::format("mean of {}, {} trials", m.name, n);
      ExpectNominal(
          Coverage(
              what,
              [&](int s) { return MeanWithInterval(Study(m, n, s), 1).interval.Holds(m.mean); },
              StudiesOf(n)),
          what);
    }
  }
}

TEST(Coverage, OfPercentilesAndTheWholeDistribution) {
  for (const Metric& m : Metrics()) {
    for (const int n : {20, 50, 200}) {
      for (const double percent : {50.0, 90.0, 95.0}) {
        const std::string what =
            fmt::format("{} % percentile of {}, {} trials", percent, m.name, n);
        const double truth = m.quantile(percent / 100.0);
        ExpectNominal(
            Coverage(what,
                     [&](int s) {
                       std::vector<double> values = Study(m, n, s);
                       std::sort(values.begin(), values.end());
                       return PercentileWithInterval(values, percent).interval.Holds(truth);
                     }),
            what);
      }
    }
  }
}

// The band holds when the empirical distribution is nowhere farther away.
TEST(Coverage, OfTheDistributionsBand) {
  const boost::math::normal normal;
  for (const int n : {20, 50, 200}) {
    const std::string what = fmt::format("DKW band, {} trials", n);
    const double band = CdfBand(static_cast<std::size_t>(n));
    ExpectNominal(
        Coverage(
            what,
            [&](int s) {
              std::vector<double> v = Study(Metrics()[0], n, s);
              std::sort(v.begin(), v.end());
              double farthest = 0.0;
              for (int i = 0; i < n; ++i) {
                const double f = boost::math::cdf(normal, v[static_cast<std::size_t>(i)]);
                farthest = std::max({farthest, (i + 1.0) / n - f, f - static_cast<double>(i) / n});
              }
              return farthest <= band;
            }),
        what);
  }
}

TEST(Coverage, OfTheStandardDeviation) {
  for (const Metric& m : {Metrics()[0], Metrics()[1]}) {
    for (const int n : {20, 50, 200}) {
      const std::string what = fmt::format("standard deviation of {}, {} trials", m.name, n);
      ExpectNominal(Coverage(
                        what,
                        [&](int s) {
                          std::vector<double> v = Study(m, n, s);
                          std::sort(v.begin(), v.end());
                          return SpreadWithInterval(v).interval.Holds(m.sigma);
                        },
                        StudiesOf(n)),
                    what);
    }
  }
}

// Pairs share the first component; the second estimator's own part is larger.
TEST(Coverage, OfPairedDifferencesAndTheImprovement) {
  for (const int n : {20, 50, 200, 1000}) {
    const auto pairs = [n](int study) {
      sim::RandomStream::Sample sample =
          sim::RandomStream(Seed(), static_cast<std::uint64_t>(study), "pairs")
              .At(static_cast<std::uint64_t>(n));
      std::pair<std::vector<double>, std::vector<double>> ab;
      for (int i = 0; i < n; ++i) {
        const std::array<double, 3> e = Errors(sample);
        ab.first.push_back(e[0] * e[0] + e[1] * e[1]);         // mean 2
        ab.second.push_back(e[0] * e[0] + 4.0 * e[2] * e[2]);  // mean 5
      }
      return ab;
    };
    const std::string mean = fmt::format("paired mean difference, {} trials", n);
    const std::string ratio = fmt::format("improvement, {} trials", n);
    ExpectNominal(Coverage(mean,
                           [&](int s) {
                             const auto [a, b] = pairs(s);
                             return Compare(a, b, 1).mean_difference.interval.Holds(-3.0);
                           }),
                  mean);
    ExpectNominal(Coverage(ratio,
                           [&](int s) {
                             const auto [a, b] = pairs(s);
                             return ImprovementWithInterval(a, b, 1).interval.Holds(0.6);
                           }),
                  ratio);
  }
}

TEST(Coverage, OfTheChiSquareBoundsOfAnees) {
  for (const int n : {20, 50, 200}) {
    const std::string what = fmt::format("chi-square bounds of ANEES, {} trials", n);
    ExpectNominal(Coverage(what,
                           [&](int s) {
                             const std::vector<double> v = Study(Metrics()[3], n, s);
                             return ChiSquareBounds(v.size(), 3.0).Holds(ComputeMoments(v).mean);
                           }),
                  what);
  }
}

// y = 2 a + b + 2 e: correlation 2/3 with a; Spearman's is 6 / pi asin(r / 2) of normal variables.
TEST(Coverage, OfTheRankCorrelation) {
  const double truth = 6.0 / M_PI * std::asin(1.0 / 3.0);
  for (const int n : {20, 50, 200}) {
    const std::string what = fmt::format("rank correlation, {} trials", n);
    ExpectNominal(Coverage(what,
                           [&](int s) {
                             sim::RandomStream::Sample sample =
                                 sim::RandomStream(Seed(), static_cast<std::uint64_t>(s), "ranks")
                                     .At(static_cast<std::uint64_t>(n));
                             std::vector<double> x;
                             std::vector<double> y;
                             for (int i = 0; i < n; ++i) {
                               const std::array<double, 3> e = Errors(sample);
                               x.push_back(e[0]);
                               y.push_back(2.0 * e[0] + e[1] + 2.0 * e[2]);
                             }
                             return RankCorrelation(x, y).interval.Holds(truth);
                           }),
                  what);
  }
}

// A count is discrete: the coverage is a sum, and depends on the true rate. Averaged over rates it
// is nominal; at single ones it is not, for any interval.
TEST(Coverage, OfTheSuccessRate) {
  for (const int n : {20, 50, 200}) {
    double sum = 0.0;
    double lowest = 1.0;
    double exact_lowest = 1.0;
    for (int k = 1; k < 1000; ++k) {
      const double p = k / 1000.0;
      const boost::math::binomial count(n, p);
      double wilson = 0.0;
      double exact = 0.0;
      for (int x = 0; x <= n; ++x) {
        const auto successes = static_cast<std::uint64_t>(x);
        const auto trials = static_cast<std::uint64_t>(n);
        const double share = boost::math::pdf(count, x);
        if (RateWithInterval(successes, trials).interval.Holds(p)) wilson += share;
        if (ExactRateInterval(successes, trials).Holds(p)) exact += share;
      }
      sum += wilson / 999.0;
      lowest = std::min(lowest, wilson);
      exact_lowest = std::min(exact_lowest, exact);
    }
    fmt::print(
        "| success rate, {} trials, mean over rates (lowest; Clopper-Pearson's lowest) | "
        "{:.1f} % ({:.1f}; {:.1f}) |\n",
        n, 100.0 * sum, 100.0 * lowest, 100.0 * exact_lowest);
    EXPECT_GE(sum, kLowest);
    EXPECT_LE(sum, kHighest);
    EXPECT_GE(exact_lowest, 0.95 - 1e-9);
  }
}

}  // namespace
}  // namespace polnav::testbed
