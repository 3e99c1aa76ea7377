// Do the scenario's disturbances make sense?
#pragma once

#include "tools/testbed/scenario.h"
#include "tools/testbed/yaml_document.h"

namespace polnav::testbed {

// Throws the InputError about the first that does not.
void CheckDisturbances(const YamlDocument& document, const Scenario& scenario);

}  // namespace polnav::testbed
