#include "nav/inertial/imu_buffer.h"

#include <algorithm>

namespace polnav::nav {
namespace {

// Of the rate's interval: a lost reading is bridged by the next one, longer gaps are not; and as
// far the last reading holds on when the next one has not come yet.
constexpr int kBridgedIntervals = 2;

}  // namespace

ImuBuffer::ImuBuffer(double rate_hz, const ImuNoise& noise)
    : interval_(FromSeconds(1.0 / rate_hz)), noise_(noise) {}

Outcome ImuBuffer::Add(const ImuSample& sample) {
  const bool late = newest_ && sample.stamp <= *newest_;
  if (late || !sample.gyro_rad_s.allFinite() || !sample.accel_m_s2.allFinite()) {
    return Outcome::kUnusable;
  }
  TimeNs begin = sample.stamp - interval_;
  if (newest_ && sample.stamp - *newest_ <= kBridgedIntervals * interval_ + interval_ / 2) {
    begin = *newest_;
  }
  readings_.push_back({begin, sample});
  newest_ = sample.stamp;
  return Outcome::kUsed;
}

bool ImuBuffer::Integrate(TimeNs from, TimeNs to, Preintegration& sum) {
  while (!readings_.empty() && readings_.front().sample.stamp <= from) readings_.pop_front();
  TimeNs at = from;
  for (const Reading& reading : readings_) {
    // A tenth of an interval: stamps are rounded and jitter.
    if (at >= to || reading.begin > at + interval_ / 10) break;
    const TimeNs end = std::min(to, reading.sample.stamp);
    if (end <= at) continue;
    sum.Add(reading.sample.gyro_rad_s, reading.sample.accel_m_s2, ToSeconds(end - at), noise_);
    at = end;
  }
  const TimeNs missing = to - at;
  if (missing > kBridgedIntervals * interval_ || (missing > 0 && at == from)) return false;
  if (missing > 0) {
    const ImuSample& last = readings_.back().sample;
    sum.Add(last.gyro_rad_s, last.accel_m_s2, ToSeconds(missing), noise_);
  }
  return true;
}

}  // namespace polnav::nav
