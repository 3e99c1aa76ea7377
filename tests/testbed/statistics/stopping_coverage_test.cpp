// Intervals of studies that stop when they know enough; see coverage.h.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "tests/testbed/statistics/coverage.h"
#include "tools/testbed/statistics/mean.h"
#include "tools/testbed/statistics/percentile.h"
#include "tools/testbed/statistics/rate.h"
#include "tools/testbed/statistics/stopping.h"

namespace polnav::testbed {
namespace {

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
          m.quantile(0.5), 1.96 * 0.5 / density, MoreLooks("median")};
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
          p, 1.96 * std::sqrt(p * (1.0 - p)), MoreLooks("success_rate")};
}

std::vector<Stopped> StoppedBy(const Metric& m) {
  const LookFunction mean = [](auto values) { return MeanWithInterval(values, 1); };
  return {{"mean", mean, m.mean, 1.96 * m.sigma, MoreLooks("mean")},
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
