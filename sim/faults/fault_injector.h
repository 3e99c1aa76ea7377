// What arrives of what the sensors said?
//
// Measurements go in one by one, in the order in which they would arrive; out come those that
// arrive now, in order of arrival. Simulated or recorded makes no difference: only measurements and
// the rig are known here. A measurement arrives at its stamp, or when it is handed in if an earlier
// one bore a later stamp; delay and reorder add to that. Stamps stay what the sensor said, but for
// a clock fault.
// Random draws belong to (seed, trial, place of the fault in the list) and the measurement's index
// in its own stream: a fault on one sensor leaves the other streams byte-identical.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "nav/api/calibration.h"
#include "nav/api/measurements.h"
#include "sim/faults/fault_options.h"
#include "sim/random.h"

namespace polnav::sim {

class FaultInjector {
 public:
  // Each fault has exactly one kind, and one that fits its sensor: else std::logic_error.
  FaultInjector(const std::vector<FaultOptions>& faults, const nav::Rig& rig, std::uint64_t seed,
                std::uint64_t trial);

  // What arrives up to and including the moment at which this one would have.
  [[nodiscard]] std::vector<nav::Measurement> Take(const nav::Measurement& measurement);

  // At the end: what is still on its way.
  [[nodiscard]] std::vector<nav::Measurement> Flush();

 private:
  struct Fault {
    FaultOptions options;
    FaultKind kind;
    nav::TimeNs begin;
    nav::TimeNs end;
    RandomStream random;
    std::optional<nav::Measurement> held;  // stuck: what comes again and again
  };
  // A measurement on its way through the faults.
  struct Passage {
    nav::Measurement measurement;
    nav::TimeNs stamp = 0;  // before any fault
    std::uint64_t index = 0;
    nav::TimeNs late = 0;
    int copies = 1;
  };

  void PassThrough(Fault& fault, Passage& passage) const;
  void ChangeReading(Fault& fault, Passage& passage, RandomStream::Sample& draw) const;
  void CorruptPictures(const CorruptFault& fault, RandomStream::Sample& draw,
                       nav::Measurement& measurement) const;

  nav::Rig rig_;
  std::map<std::string, std::vector<Fault>> faults_;  // by sensor, in the order in which they act
  std::map<std::string, std::uint64_t> counts_;       // of measurements, by sensor
  nav::TimeNs now_ = 0;
  bool started_ = false;
  std::multimap<nav::TimeNs, nav::Measurement> under_way_;  // by arrival; equal ones as sent
};

}  // namespace polnav::sim
