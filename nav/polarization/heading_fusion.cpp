#include "nav/polarization/heading_fusion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "nav/polarization/six_channel.h"
#include "nav/polarization/sky_heading.h"

namespace polnav::nav {
namespace {

// The first edge carries the slow part's whole information: worth a second of readings.
constexpr int kFirstReadings = 20;

}  // namespace

HeadingFusion::HeadingFusion(const PolarizationOptions& options,
                             const PolarimeterCalibration& calibration, SunModel sun)
    : options_(options), calibration_(calibration), sun_(std::move(sun)) {}

Outcome HeadingFusion::Add(const PolarizationSample& sample) {
  const auto e_B = UsableEVector(sample, options_, calibration_);
  if (!e_B) return Outcome::kUnusable;
  const auto same = [&](const Reading& r) { return r.stamp == sample.stamp; };
  const bool late = advanced_to_ && sample.stamp < *advanced_to_;  // no attitude is kept for it
  if (late || std::any_of(waiting_.begin(), waiting_.end(), same)) return Outcome::kUnusable;
  waiting_.push_back({sample.stamp, *e_B});
  return Outcome::kUsed;
}

int HeadingFusion::Advance(TimeNs from, const Eigen::Quaterniond& q_from, TimeNs to,
                           const Eigen::Quaterniond& q_to, double heading_variance) {
  const double white = DegToRad(options_.reading_sigma_deg);
  const double slow = DegToRad(options_.correlated_sigma_deg);
  const double limit =
      options_.gate_sigmas * std::sqrt(white * white + slow * slow + heading_variance);
  int gated = 0;
  const auto later = [&](const Reading& r) { return r.stamp > to; };
  for (const Reading& reading : waiting_) {
    if (later(reading)) continue;
    const double share =
        to > from ? std::clamp(ToSeconds(reading.stamp - from) / ToSeconds(to - from), 0.0, 1.0)
                  : 1.0;
    const Eigen::Quaterniond q_WB = q_from.slerp(share, q_to);
    const auto heading = HeadingFromEVector(reading.e_B, q_WB, sun_(reading.stamp));
    const double innovation = heading ? WrapPi(*heading - CompassHeading(q_WB)) : limit + 1.0;
    if (std::abs(innovation) > limit) {
      ++gated;
      continue;
    }
    ++innovations_;
    innovation_sum_rad_ += innovation;
  }
  std::erase_if(waiting_, [&](const Reading& r) { return !later(r); });
  advanced_to_ = to;
  return gated;
}

void HeadingFusion::Forget() {
  innovation_sum_rad_ = 0.0;
  innovations_ = 0;
}

std::optional<HeadingEdge> HeadingFusion::TakeEdge(TimeNs stamp, const Eigen::Quaterniond& q_WB) {
  const bool first = !last_edge_;
  if (innovations_ < (first ? kFirstReadings : 1)) return std::nullopt;
  const double n = innovations_;
  const double mean = innovation_sum_rad_ / n;
  const double white = DegToRad(options_.reading_sigma_deg);
  const double slow = DegToRad(options_.correlated_sigma_deg);
  // The slow part counts once at the start; after that, as often as it has changed.
  const double slow_share =
      last_edge_ ? std::max(1.0, 2.0 * options_.correlation_time_s / ToSeconds(stamp - *last_edge_))
                 : 1.0;
  Forget();
  last_edge_ = stamp;
  return HeadingEdge{.heading_rad = WrapPi(CompassHeading(q_WB) + mean),
                     .sigma_rad = std::sqrt(white * white / n + slow * slow * slow_share)};
}

}  // namespace polnav::nav
