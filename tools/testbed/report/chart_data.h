// What do the report's charts draw? One object, thinned, in metres, degrees and seconds.
#pragma once

#include "sim/faults/fault_options.h"
#include "tools/testbed/option_tree.h"
#include "tools/testbed/run_record.h"

namespace polnav::testbed {

[[nodiscard]] Json ChartData(const RunRecord& record,
                             const std::vector<sim::FaultOptions>& faults = {});

}  // namespace polnav::testbed
