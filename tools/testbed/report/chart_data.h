// What do the report's charts draw? One object, thinned, in metres, degrees and seconds.
#pragma once

#include "tools/testbed/option_tree.h"
#include "tools/testbed/run_record.h"
#include "tools/testbed/scenario.h"

namespace polnav::testbed {

// Of the scenario: what was disturbed, and when.
[[nodiscard]] Json ChartData(const RunRecord& record, const Scenario& scenario);

}  // namespace polnav::testbed
