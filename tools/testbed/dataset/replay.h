// What would the estimators have said, had they heard this recording live?
//
// The same listeners, faults and hashes as in the closed loop, fed from a dataset. A recording of a
// run gives the estimates of that run, byte for byte. With truth, the estimators are told the first
// true pose as a scenario grants it, and whatever was measured before it is passed over; without,
// they start at the origin, looking north. No truth goes anywhere else.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/testbed/dataset/dataset.h"
#include "tools/testbed/input_error.h"
#include "tools/testbed/run_record.h"
#include "tools/testbed/scenario.h"

namespace polnav::testbed {

struct ReplayOutcome {
  RunRecord record;
  std::vector<std::string> problems;  // frames left out, one reason each
  std::uint64_t before_start = 0;     // measurements from before the first truth
  // The dataset broke off here; the record is what came before.
  std::optional<InputError> failure;
};

// settings: see ReplaySettings. progress: called with the fraction done, 0 to 1; may be empty.
[[nodiscard]] ReplayOutcome Replay(Dataset dataset, const Scenario& settings,
                                   const std::function<void(double fraction)>& progress);

}  // namespace polnav::testbed
