// Which readings of the IMU lie between two instants?
//
// Keeps readings until a frame asks for them: a picture may come before or after the readings of
// its own time. A reading is the mean over the interval since the one before.
#pragma once

#include <deque>
#include <optional>

#include "nav/api/estimate.h"
#include "nav/api/measurements.h"
#include "nav/inertial/preintegration.h"

namespace polnav::nav {

class ImuBuffer {
 public:
  // rate: as the data sheet has it [Hz]. A gap of more than a few intervals is a gap.
  ImuBuffer(double rate_hz, const ImuNoise& noise);

  // Unusable: not finite, late, or the same once more.
  Outcome Add(const ImuSample& sample);

  // Adds the readings of (from, to] to the sum, the ones at the ends in part, and forgets those
  // before `to`. False when readings are missing: the sum then means nothing.
  [[nodiscard]] bool Integrate(TimeNs from, TimeNs to, Preintegration& sum);

 private:
  struct Reading {
    TimeNs begin;
    ImuSample sample;
  };

  TimeNs interval_;
  ImuNoise noise_;
  std::deque<Reading> readings_;
  std::optional<TimeNs> newest_;
};

}  // namespace polnav::nav
