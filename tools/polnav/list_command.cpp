#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>

#include "tools/polnav/commands.h"
#include "tools/testbed/estimators.h"
#include "tools/testbed/input_error.h"
#include "tools/testbed/metrics.h"
#include "tools/testbed/scenario.h"
#include "tools/testbed/study/study_plan.h"

namespace polnav::testbed {
namespace {

namespace fs = std::filesystem;

// The working folder's scenarios, else those of the source tree this was built from.
fs::path ScenarioFolder() {
  return fs::is_directory("scenarios") ? fs::path("scenarios")
                                       : fs::path(POLNAV_SOURCE_DIR) / "scenarios";
}

std::vector<fs::path> YamlFiles(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_regular_file() && entry.path().extension() == ".yaml") {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string FirstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

void ListFiles(const fs::path& folder, const Console& console,
               const std::function<std::string(const fs::path&)>& description) {
  for (const fs::path& file : YamlFiles(folder)) {
    std::string text;
    try {
      text = FirstLine(description(file));
    } catch (const InputError& error) {
      text = std::string("INVALID: ") + error.what();
    }
    console.out << "  " << file.string() << "\n      " << text << "\n";
  }
}

}  // namespace

int List(const Console& console) {
  console.out << "scenarios\n";
  ListFiles(ScenarioFolder(), console,
            [](const fs::path& file) { return LoadScenario(file).description; });
  console.out << "\nstudies\n";
  ListFiles(ScenarioFolder() / "studies", console, [](const fs::path& file) {
    const StudyPlan plan = LoadStudy(file);
    return fmt::format("{} ({}{} trials)", FirstLine(plan.options().description),
                       plan.options().stop.empty() ? "" : "at most ", plan.trial_count());
  });
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
