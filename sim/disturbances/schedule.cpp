#include "sim/disturbances/schedule.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "sim/random.h"

namespace polnav::sim {
namespace {

constexpr double kRamp_s = 1.0;

bool IsStretch(const DisturbanceOptions& entry) {
  return entry.low_features || entry.canopy || entry.tunnel || entry.bridge;
}

// From 0 at the ends of the event to 1, with continuous slope.
double ShareAt(const DisturbanceEvent& event, double t_s) {
  const double ramp = std::min(kRamp_s, 0.25 * (event.end_s - event.start_s));
  const double x = std::clamp(std::min(t_s - event.start_s, event.end_s - t_s) / ramp, 0.0, 1.0);
  return x * x * (3.0 - 2.0 * x);
}

double Covered(double already, double more) { return 1.0 - (1.0 - already) * (1.0 - more); }

}  // namespace

std::vector<DisturbanceEvent> ScheduleDisturbances(const std::vector<DisturbanceOptions>& entries,
                                                   double duration_s, std::uint64_t seed,
                                                   std::uint64_t trial) {
  std::vector<DisturbanceEvent> events;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const DisturbanceOptions& entry = entries[i];
    if (IsStretch(entry)) continue;
    if (!entry.mean_interval_s) {
      events.push_back({entry.start_s, entry.start_s + entry.duration_s, entry});
      continue;
    }
    const RandomStream stream(seed, trial, "disturbance/" + std::to_string(i));
    double start_s = entry.start_s;
    for (std::uint64_t k = 0;; ++k) {
      RandomStream::Sample draw = stream.At(k);
      start_s += -*entry.mean_interval_s * std::log(1.0 - draw.Uniform());
      if (start_s >= duration_s) break;
      events.push_back({start_s, start_s + entry.duration_s, entry});
    }
  }
  return events;
}

CameraConditions ConditionsAt(const std::vector<DisturbanceEvent>& events, nav::TimeNs stamp) {
  const double t_s = nav::ToSeconds(stamp);
  CameraConditions now;
  double blur_1_m = 0.0;  // extinctions add up, and each is in inverse proportion to visibility
  for (const DisturbanceEvent& event : events) {
    const double share = ShareAt(event, t_s);
    if (share == 0.0) continue;
    const DisturbanceOptions& what = event.what;
    // Eyes and sensors count light in powers: half way down is half the exponent.
    if (what.darkness) {
      now.light_share *= std::pow(std::max(what.darkness->light_share, 1e-6), share);
    }
    if (what.overexposure) now.gain_share *= std::pow(what.overexposure->gain, share);
    if (what.glare) now.glare += share * what.glare->strength;
    if (what.fog) blur_1_m += share / what.fog->visibility_m;
    if (what.rain) now.rain_share = Covered(now.rain_share, share * what.rain->share);
    if (what.dirt) now.dirt_share = Covered(now.dirt_share, share * what.dirt->share);
  }
  if (blur_1_m > 0.0) now.visibility_m = 1.0 / blur_1_m;
  return now;
}

}  // namespace polnav::sim
