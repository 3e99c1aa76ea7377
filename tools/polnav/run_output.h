// Where do the results of a run or a replay go? Files into a folder, a table on the terminal.
#pragma once

#include <filesystem>
#include <string>

#include "tools/polnav/console.h"
#include "tools/testbed/output_folder.h"
#include "tools/testbed/run_record.h"
#include "tools/testbed/scenario.h"

namespace polnav::testbed {

struct RunOutput {
  const Scenario& scenario;
  RunRecord record;
  std::string level;         // image, measurement, replay
  std::string command_line;  // as typed
  bool quiet = false;
  bool json = false;
  // Replays only.
  Alignment alignment = Alignment::kNone;  // of the estimates to the truth, before any score
  nav::TimeNs epoch = 0;                   // added to the stamps in .tum files
};

// Writes result.json, truth.tum, <estimator>.tum, junit.xml, report.html, scenario.yaml; prints.
// Returns the exit code.
[[nodiscard]] int Deliver(const RunOutput& output, OutputFolder& folder, const Console& console);

}  // namespace polnav::testbed
