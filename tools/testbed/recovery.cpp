#include "tools/testbed/recovery.h"

#include <algorithm>
#include <cmath>

namespace polnav::testbed {
namespace {

constexpr double kHold_s = 1.0;
constexpr double kLeastBefore_s = 5.0;

// Overlapping ones as one.
std::vector<Stretch> Merged(std::vector<Stretch> stretches) {
  std::sort(stretches.begin(), stretches.end(),
            [](const Stretch& a, const Stretch& b) { return a.begin_s < b.begin_s; });
  std::vector<Stretch> merged;
  for (const Stretch& s : stretches) {
    if (!merged.empty() && s.begin_s <= merged.back().end_s) {
      merged.back().end_s = std::max(merged.back().end_s, s.end_s);
    } else {
      merged.push_back(s);
    }
  }
  return merged;
}

struct Sample {
  double t_s;
  bool good;
};

// From begin_s on, how long until the samples are good for kHold_s, at most to until_s.
double TimeToRecover(const std::vector<Sample>& samples, double begin_s, double until_s) {
  double since_s = begin_s;
  for (const Sample& sample : samples) {
    if (sample.t_s < begin_s) continue;
    if (sample.t_s > until_s) break;
    if (sample.t_s - since_s >= kHold_s) return since_s - begin_s;
    if (!sample.good) since_s = sample.t_s;
  }
  return until_s - since_s >= kHold_s ? since_s - begin_s : until_s - begin_s;
}

// 95 % of the errors before begin_s. Nothing when there are too few.
std::optional<double> UsualHeading(const ErrorSeries& errors, double begin_s) {
  std::vector<double> before;
  for (std::size_t i = 0; i < errors.t_s.size() && errors.t_s[i] < begin_s; ++i) {
    before.push_back(std::abs(errors.heading_deg[i]));
  }
  if (before.empty() || begin_s - errors.t_s.front() < kLeastBefore_s) return std::nullopt;
  return Percentile(before, 95.0);
}

}  // namespace

std::optional<Recovery> ScoreRecovery(const std::vector<Stretch>& disturbed,
                                      const ErrorSeries& errors,
                                      const std::vector<nav::Estimate>& estimates) {
  const std::vector<Stretch> stretches = Merged(disturbed);
  if (stretches.empty() || errors.t_s.empty()) return std::nullopt;
  std::vector<Sample> tracking;
  for (const nav::Estimate& e : estimates) tracking.push_back({nav::ToSeconds(e.stamp), e.tracked});
  const std::optional<double> usual = UsualHeading(errors, stretches.front().begin_s);
  std::vector<Sample> heading;
  for (std::size_t i = 0; usual && i < errors.t_s.size(); ++i) {
    heading.push_back({errors.t_s[i], std::abs(errors.heading_deg[i]) <= *usual});
  }
  Recovery recovery;
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    const double end_s = stretches[i].end_s;
    const double until_s = i + 1 < stretches.size() ? stretches[i + 1].begin_s : errors.t_s.back();
    if (until_s - end_s < kHold_s) continue;
    ++recovery.disturbances;
    recovery.tracking_s = std::max(recovery.tracking_s, TimeToRecover(tracking, end_s, until_s));
    if (!usual) continue;
    recovery.heading_s =
        std::max(recovery.heading_s.value_or(0.0), TimeToRecover(heading, end_s, until_s));
  }
  return recovery.disturbances > 0 ? std::optional(recovery) : std::nullopt;
}

}  // namespace polnav::testbed
