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
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sim/random.h"

namespace polnav::testbed {

std::uint64_t Seed();

// Of a row with n trials a study.
int StudiesOf(int n = 1000);

inline constexpr double kLowest = 0.935;
inline constexpr double kHighest = 0.965;

struct Metric {
  const char* name;
  double mean;
  double sigma;
  std::function<double(const std::array<double, 3>&)> of;  // of the errors
  std::function<double(double)> quantile;
};

const std::vector<Metric>& Metrics();

std::array<double, 3> Errors(sim::RandomStream::Sample& sample);

std::vector<double> Study(const Metric& metric, int n, int study, const char* stream = "linear");

// Share of the studies in which it holds; printed.
double Coverage(const std::string& what, const std::function<bool(int)>& holds,
                int studies = StudiesOf());

void ExpectNominal(double share, const std::string& what, double highest = kHighest);

}  // namespace polnav::testbed
