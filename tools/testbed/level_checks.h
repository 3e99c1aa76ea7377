// Does the scenario mean anything at this level? At measurement level no picture is drawn.
#pragma once

#include <vector>

#include "sim/faults/fault_options.h"
#include "sim/simulator.h"
#include "tools/testbed/scenario.h"
#include "tools/testbed/yaml_document.h"

namespace polnav::testbed {

// Throws InputError at measurement level: what only pictures have is asked for or fails.
void CheckLevel(const YamlDocument& document, const Scenario& scenario, sim::Level level);

// At measurement level a fault of `stereo` acts on what is seen in place of its pictures.
[[nodiscard]] std::vector<sim::FaultOptions> FaultsAt(sim::Level level,
                                                      std::vector<sim::FaultOptions> faults);

}  // namespace polnav::testbed
