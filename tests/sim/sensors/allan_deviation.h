// How much do means over tau differ from one to the next? The Allan deviation of a recording, and
// what it is for the noises that an inertial sensor is made of [IEEE1997, annex C].
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace polnav::sim {

// Overlapping estimate from equidistant samples; means over `mean_of` of them.
inline double AllanVariance(const std::vector<double>& samples, std::size_t mean_of) {
  std::vector<double> sum = {0.0};
  for (const double sample : samples) sum.push_back(sum.back() + (sample - samples.front()));
  const std::size_t count = samples.size() - 2 * mean_of + 1;
  double square = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    square += std::pow(sum[i + 2 * mean_of] - 2.0 * sum[i + mean_of] + sum[i], 2);
  }
  const auto m = static_cast<double>(mean_of);
  return square / (2.0 * m * m * static_cast<double>(count));
}

// White noise, flicker, random walk of the bias: what the options say.
struct AllanParameters {
  double noise_sqrt_hz = 0.0;
  double flicker_floor = 0.0;
  double walk_sqrt_s = 0.0;
  double resolution = 0.0;

  // The three straight lines of the textbook, summed.
  [[nodiscard]] double TextbookDeviation(double tau_s) const {
    return std::sqrt(noise_sqrt_hz * noise_sqrt_hz / tau_s + flicker_floor * flicker_floor +
                     walk_sqrt_s * walk_sqrt_s * tau_s / 3.0);
  }
};

// Of a first-order Gauss-Markov process of variance 1, sampled (not averaged) every step_s: twice
// the variance of a mean over m samples minus twice the covariance of two neighbours, halved.
inline double MarkovAllanVariance(double correlation_time_s, double step_s, std::size_t m) {
  const double kept = std::exp(-step_s / correlation_time_s);
  const auto n = static_cast<double>(m);
  double sum = n;
  double power = 1.0;
  for (std::size_t k = 1; k < 2 * m; ++k) {
    power *= kept;
    const auto lag = static_cast<double>(k);
    if (k < m) sum += 2.0 * (n - lag) * power;
    sum -= (k <= m ? lag : 2.0 * n - lag) * power;
  }
  return sum / (n * n);
}

// The same of a process that is averaged, not sampled; x = tau over the correlation time.
inline double MarkovAllanVariance(double x) {
  if (x < 1e-3) return 2.0 / 3.0 * x - 0.5 * x * x;  // next term 7/30 x^3
  return 2.0 / x * (1.0 + (4.0 * std::exp(-x) - std::exp(-2.0 * x) - 3.0) / (2.0 * x));
}

// Flicker as flicker_noise.h builds it, written down a second time: one process a decade, with the
// density floor^2 / (2 ln 2 f) between them.
inline double ModelAllanDeviation(const AllanParameters& p, double step_s, std::size_t m) {
  const auto n = static_cast<double>(m);
  const double markov_variance =
      p.flicker_floor * p.flicker_floor * std::numbers::ln10 / (2.0 * std::numbers::ln2);
  double variance = p.noise_sqrt_hz * p.noise_sqrt_hz / (n * step_s) +
                    p.walk_sqrt_s * p.walk_sqrt_s * step_s * (2.0 * n * n + 1.0) / (6.0 * n) +
                    p.resolution * p.resolution / (12.0 * n);
  for (const double time_s : {0.1, 1.0, 1e1, 1e2, 1e3, 1e4, 1e5}) {
    variance += markov_variance * MarkovAllanVariance(time_s, step_s, m);
  }
  return std::sqrt(variance);
}

// Its limit for samples without end, and without the converter's steps.
inline double ModelAllanDeviation(const AllanParameters& p, double tau_s) {
  const double markov_variance =
      p.flicker_floor * p.flicker_floor * std::numbers::ln10 / (2.0 * std::numbers::ln2);
  double variance =
      p.noise_sqrt_hz * p.noise_sqrt_hz / tau_s + p.walk_sqrt_s * p.walk_sqrt_s * tau_s / 3.0;
  for (const double time_s : {0.1, 1.0, 1e1, 1e2, 1e3, 1e4, 1e5}) {
    variance += markov_variance * MarkovAllanVariance(tau_s / time_s);
  }
  return std::sqrt(variance);
}

}  // namespace polnav::sim
