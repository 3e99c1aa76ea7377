// Can the optical-flow sensor measure anything where the scenario puts it?
#pragma once

#include "tools/testbed/scenario.h"
#include "tools/testbed/yaml_document.h"

namespace polnav::testbed {

// Throws InputError: rates that do not fit, a range that is empty, a sensor out of its range.
void CheckFlow(const YamlDocument& document, const Scenario& scenario);

}  // namespace polnav::testbed
