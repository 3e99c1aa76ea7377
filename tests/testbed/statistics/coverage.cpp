#include "tests/testbed/statistics/coverage.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <cstdlib>

namespace polnav::testbed {
namespace {

std::uint64_t FromEnvironment(const char* name, std::uint64_t otherwise) {
  const char* const text = std::getenv(name);
  return text == nullptr ? otherwise : std::stoull(text);
}

}  // namespace

std::uint64_t Seed() { return FromEnvironment("POLNAV_COVERAGE_SEED", 2026); }

int StudiesOf(int n) {
  constexpr int kStudies = 2000;
  const int studies = n <= 50 ? 5 * kStudies : kStudies;
  return static_cast<int>(
      FromEnvironment("POLNAV_COVERAGE_STUDIES", static_cast<std::uint64_t>(studies)));
}

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

std::vector<double> Study(const Metric& metric, int n, int study, const char* stream) {
  sim::RandomStream::Sample sample =
      sim::RandomStream(Seed(), static_cast<std::uint64_t>(study), stream)
          .At(static_cast<std::uint64_t>(n));
  std::vector<double> values;
  for (int i = 0; i < n; ++i) values.push_back(metric.of(Errors(sample)));
  return values;
}

double Coverage(const std::string& what, const std::function<bool(int)>& holds, int studies) {
  int hits = 0;
  for (int s = 0; s < studies; ++s) hits += holds(s) ? 1 : 0;
  const double share = static_cast<double>(hits) / studies;
  fmt::print("| {} | {:.1f} % |\n", what, 100.0 * share);
  return share;
}

void ExpectNominal(double share, const std::string& what, double highest) {
  EXPECT_GE(share, kLowest) << what;
  EXPECT_LE(share, highest) << what;
}

}  // namespace polnav::testbed
