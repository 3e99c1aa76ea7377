#include <algorithm>
#include <filesystem>

#include "tools/polnav/commands.h"
#include "tools/testbed/estimators.h"
#include "tools/testbed/input_error.h"
#include "tools/testbed/metrics.h"
#include "tools/testbed/scenario.h"

namespace polnav::testbed {
namespace {

namespace fs = std::filesystem;

// The working folder's scenarios, else those of the source tree this was built from.
fs::path ScenarioFolder() {
  return fs::is_directory("scenarios") ? fs::path("scenarios")
                                       : fs::path(POLNAV_SOURCE_DIR) / "scenarios";
}

std::vector<fs::path> ScenarioFiles() {
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(ScenarioFolder(), error)) {
    if (entry.is_regular_file() && entry.path().extension() == ".yaml") {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string FirstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

int List(const Console& console) {
  console.out << "scenarios\n";
  for (const fs::path& file : ScenarioFiles()) {
    try {
      const Scenario scenario = LoadScenario(file);
      console.out << "  " << file.string() << "\n      " << FirstLine(scenario.description) << "\n";
    } catch (const InputError& error) {
      console.out << "  " << file.string() << "\n      INVALID: " << error.what() << "\n";
    }
  }
  console.out << "\nestimators\n";
  for (const EstimatorInfo& info : kEstimators) {
    console.out << "  " << info.name << "\n      " << info.description << "\n";
  }
  console.out << "\nmetrics\n  sim_duration_s\n  wall_s\n  real_time_factor\n  peak_rss_mb\n"
                 "  streams.<stream>.count\n  timing_ms.<stage>.median\n  timing_ms.<stage>.p99\n";
  for (const std::string& metric : EstimatorMetrics()) {
    console.out << "  estimators.<name>." << metric << "\n";
  }
  return kExitHolds;
}

}  // namespace polnav::testbed
