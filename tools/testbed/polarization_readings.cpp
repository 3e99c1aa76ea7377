#include "tools/testbed/polarization_readings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "nav/polarization/six_channel.h"
#include "nav/polarization/sky_heading.h"

namespace polnav::testbed {

PolarizationReadings::PolarizationReadings(
    const std::optional<nav::PolarimeterCalibration>& calibration, nav::SunModel sun)
    : calibration_(calibration), sun_(std::move(sun)) {}

void PolarizationReadings::Add(const nav::PolarizationSample& sample) {
  const auto light = nav::DecodeSixChannels(sample);
  if (!light) return;
  const Eigen::Vector3d e_S(std::cos(light->axis_rad), std::sin(light->axis_rad), 0.0);
  readings_.push_back({sample.stamp, calibration_.value().T_BS.q * e_S});
}

std::vector<HeadingReading> PolarizationReadings::ErrorsAgainst(
    const std::vector<sim::Truth>& truth) const {
  std::vector<HeadingReading> errors;
  std::vector<Reading> readings = readings_;  // they may have arrived in another order
  std::stable_sort(readings.begin(), readings.end(),
                   [](const Reading& a, const Reading& b) { return a.stamp < b.stamp; });
  std::size_t next = 1;
  for (const Reading& reading : readings) {
    if (truth.empty() || reading.stamp < truth.front().stamp) continue;
    while (next < truth.size() && truth[next].stamp < reading.stamp) ++next;
    if (next >= truth.size()) break;
    const sim::Truth& a = truth[next - 1];
    const sim::Truth& b = truth[next];
    const double share =
        nav::ToSeconds(reading.stamp - a.stamp) / nav::ToSeconds(b.stamp - a.stamp);
    const double heading = nav::CompassHeading(a.T_WB.q.slerp(share, b.T_WB.q));
    const auto read =
        nav::HeadingFromEVector(reading.e_B, nav::LevelAttitude(heading), sun_(reading.stamp));
    if (read) errors.push_back({nav::ToSeconds(reading.stamp), nav::WrapPi(*read - heading)});
  }
  return errors;
}

}  // namespace polnav::testbed
