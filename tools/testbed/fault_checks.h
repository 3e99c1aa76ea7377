// Do these faults make sense in this scenario?
#pragma once

#include "tools/testbed/scenario.h"
#include "tools/testbed/yaml_document.h"

namespace polnav::testbed {

// Throws InputError: no such sensor on board, not exactly one kind, a kind or amount that the
// sensor has no use for, after the end, or two that exclude each other.
void CheckFaults(const YamlDocument& document, const Scenario& scenario, sim::Level level);

}  // namespace polnav::testbed
