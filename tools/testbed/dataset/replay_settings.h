// With which estimators, faults and criteria is a recorded dataset heard?
//
// A scenario, of which only name, seed, site, faults, estimators and criteria matter: the
// dataset's own scenario.yaml where it has one, or else defaults from the sensors that it has.
#pragma once

#include <vector>

#include "tools/testbed/dataset/dataset.h"
#include "tools/testbed/scenario.h"

namespace polnav::testbed {

// Throws InputError as a scenario file does; also for an override that a replay could not follow.
[[nodiscard]] Scenario ReplaySettings(const DatasetInfo& info,
                                      const std::vector<ScenarioOverride>& overrides);

// Names of the estimators that these sensors allow and that are run when nobody says which.
[[nodiscard]] std::vector<std::string> DefaultEstimators(const nav::Rig& rig);

// Some estimator asks where the sun is, and so for the right place and date.
[[nodiscard]] bool NeedsSun(const Scenario& scenario);

}  // namespace polnav::testbed
