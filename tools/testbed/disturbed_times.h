// When was the run disturbed?
#pragma once

#include <cstdint>
#include <vector>

#include "tools/testbed/run_record.h"
#include "tools/testbed/scenario.h"

namespace polnav::testbed {

// Of every disturbance: when it happened in this trial, or, where it is a part of the road, when
// the vehicle was on it.
[[nodiscard]] std::vector<Stretch> DisturbedTimes(const Scenario& scenario, std::uint64_t trial,
                                                  const std::vector<sim::Truth>& truth);

// Of every fault, up to the end of the run.
[[nodiscard]] std::vector<Stretch> FaultTimes(const std::vector<sim::FaultOptions>& faults,
                                              double end_s);

}  // namespace polnav::testbed
