// How often do nominal 95 % intervals hold the truth? Over 2,000 synthetic studies each.
//
// The linear problem: a state of three independent components, each estimated from a measurement
// with unit noise. A trial's metrics have known distributions: one component's error is normal, the
// RMSE is chi of 3 over sqrt(3), a component's squared error chi-square of 1 (skewness 2.8), the
// NEES chi-square of 3. 2,000 studies measure a coverage of 95 % to 0.49 %, one sigma: 93.5 to
// 96.5 % is three.
// Rows of up to 50 trials are quick: 10,000 studies, 0.22 %.
// Prints the table of docs/study_statistics.md. POLNAV_COVERAGE_SEED draws other studies, and
// POLNAV_COVERAGE_STUDIES so many of them for every row; the bounds below are for the defaults.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "sim/random.h"
#include "tools/testbed/statistics/consistency.h"
#include "tools/testbed/statistics/mean.h"
#include "tools/testbed/statistics/paired.h"
#include "tools/testbed/statistics/percentile.h"
#include "tools/testbed/statistics/rate.h"
#include "tools/testbed/statistics/sensitivity.h"
#include "tools/testbed/statistics/stopping.h"

namespace polnav::testbed {
namespace {

std::uint64_t FromEnvironment(const char* name, std::uint64_t otherwise) {
  const char* const text = std::getenv(name);
  return text == nullptr ? otherwise : std::stoull(text);
}

std::uint64_t Seed() { return FromEnvironment("POLNAV_COVERAGE_SEED", 2026); }

// Of a row with n trials a study.
int StudiesOf(int n = 1000) {
  constexpr int kStudies = 2000;
  const int studies = n <= 50 ? 5 * kStudies : kStudies;
  return static_cast<int>(
      FromEnvironment("POLNAV_COVERAGE_STUDIES", static_cast<std::uint64_t>(studies)));
}

constexpr double kLowest = 0.935;
constexpr double kHighest = 0.965;

struct Metric {
  const char* name;
  double mean;
  double sigma;
  std::function<double(const std::array<double, 3>&)> of;  // of the errors
  std::function<double(double)> quantile;
};

const std::vector<Metric>& Metrics() {
  static const boost::math::normal normal;
  static const boost::math::chi_squared chi1(1.0);
  static const boost::math::chi_squared chi3(3.0);
  static const double rmse_mean = std::sqrt(8.0 / M_PI / 3.0);
  static const std::vector<Metric> metrics{
      {"error", 0.0, 1.0, [](const auto& e) { return e[0]; },
       [](double p) { return boost::math::quantile(normal, p); }},
      {"RMSE", rmse_mean, std::sqrt(1.0 - rmse_mean * rmse_mean),
       [](const auto& e) { return std::sqrt((e[0] * e[0] + e[1] * e[1] + e[2] * e[2]) / 3.0); },
       [](double p) { return std::sqrt(boost::math::quantile(chi3, p) / 3.0); }},
      {"squared error", 1.0, std::sqrt(2.0), [](const auto& e) { return e[0] * e[0]; },
       [](double p) { return boost::math::quantile(chi1, p); }},
      {"NEES", 3.0, std::sqrt(6.0),
       [](const auto& e) { return e[0] * e[0] + e[1] * e[1] + e[2] * e[2]; },
       [](double p) { return boost::math::quantile(chi3, p); }}};
  return metrics;
}

std::array<double, 3> Errors(sim::RandomStream::Sample& sample) {
  return {sample.Gaussian(), sample.Gaussian(), sample.Gaussian()};
}

std::vector<double> Study(const Metric& metric, int n, int study, const char* stream = "linear") {
  sim::RandomStream::Sample sample =
      sim::RandomStream(Seed(), static_cast<std::uint64_t>(study), stream)
          .At(static_cast<std::uint64_t>(n));
  std::vector<double> values;
  for (int i = 0; i < n; ++i) values.push_back(metric.of(Errors(sample)));
  return values;
}

// Share of the studies in which it holds; printed.
double Coverage(const std::string& what, const std::function<bool(int)>& holds,
                int studies = StudiesOf()) {
  int hits = 0;
  for (int s = 0; s < studies; ++s) hits += holds(s) ? 1 : 0;
  const double share = static_cast<double>(hits) / studies;
  fmt::print("| {} | {:.1f} % |\n", what, 100.0 * share);
  return share;
}

void ExpectNominal(double share, const std::string& what, double highest = kHighest,
                   double lowest = kLowest) {
  EXPECT_GE(share, lowest) << what;
  EXPECT_LE(share, highest) << what;
}

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

// What a study can stop by: a statistic, its true value, and 1.96 sigma of it for one trial.
struct Stopped {
  std::string name;
  LookFunction statistic;
  double truth;
  double spread;
  int more_looks;
};

// The spread of a median is 1/2 over the density there.
Stopped StoppedMedian(const Metric& m) {
  const double density = 2e-4 / (m.quantile(0.5 + 1e-4) - m.quantile(0.5 - 1e-4));
  return {"median",
          [](std::span<const double> values) {
            std::vector<double> sorted(values.begin(), values.end());
            std::sort(sorted.begin(), sorted.end());
            return PercentileWithInterval(sorted, 50.0);
          },
          m.quantile(0.5), 1.96 * 0.5 / density, 2};
}

// The share below a percentile.
Stopped StoppedRate(const Metric& m, double percent) {
  const double p = percent / 100.0;
  const double limit = m.quantile(p);
  return {fmt::format("success rate {}", p),
          [limit](std::span<const double> values) -> Estimated {
            const auto count = static_cast<std::uint64_t>(
                std::count_if(values.begin(), values.end(), [&](double v) { return v <= limit; }));
            return {static_cast<double>(count) / static_cast<double>(values.size()),
                    ExactRateInterval(count, values.size())};
          },
          p, 1.96 * std::sqrt(p * (1.0 - p)), 0};
}

std::vector<Stopped> StoppedBy(const Metric& m) {
  const LookFunction mean = [](auto values) { return MeanWithInterval(values, 1); };
  return {{"mean", mean, m.mean, 1.96 * m.sigma, 1},
          StoppedMedian(m),
          StoppedRate(m, 50.0),
          StoppedRate(m, 90.0)};
}

// Stopped where the interval is as narrow as 100 to 400 trials would make it. Exact intervals of
// rates cover more than 95 %.
TEST(Coverage, AfterSequentialStopping) {
  for (const Metric& m : Metrics()) {
    for (const Stopped& by : StoppedBy(m)) {
      for (const int aim : {100, 200, 400}) {
        const double half_width = by.spread / std::sqrt(aim);
        double trials = 0.0;
        const std::string what =
            fmt::format("{} of {}, stopped at a half-width of {:.3f}", by.name, m.name, half_width);
        const double share = Coverage(what, [&](int s) {
          const std::vector<double> v = Study(m, 6 * aim + 400, s, "stopped");
          const auto stop =
              StopsAt(v, {.half_width = half_width, .more_looks = by.more_looks}, by.statistic);
          if (!stop) return false;
          trials += static_cast<double>(*stop) / StudiesOf();
          return by.statistic(std::span(v).first(*stop)).interval.Holds(by.truth);
        });
        const bool rate = by.name.starts_with("success");
        ExpectNominal(share, what, rate ? 1.0 : kHighest);
        fmt::print("|   trials it took, on average | {:.0f} |\n", trials);
      }
    }
  }
}

}  // namespace
}  // namespace polnav::testbed
