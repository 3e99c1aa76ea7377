// A scenario and a run to test with: a car on a circle, and estimators with simple, known errors.
// It takes the closed loop's place where only what comes after it is under test.
#pragma once

#include <string>

#include "tools/testbed/closed_loop.h"
#include "tools/testbed/run_record.h"
#include "tools/testbed/scenario.h"

namespace polnav::testbed {

// With both estimators, criteria that hold, and all sensors they need.
[[nodiscard]] std::string ExampleScenarioYaml();

// Headings are wrong by 2 degrees (stereo) or 0.5 degrees (stereo_polarization), throughout.
[[nodiscard]] RunRecord ExampleRun(const Scenario& scenario, const RunOptions& options,
                                   const std::function<void(double)>& progress);

}  // namespace polnav::testbed
