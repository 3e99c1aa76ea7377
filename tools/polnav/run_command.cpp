#include <filesystem>

#include "tools/polnav/commands.h"
#include "tools/polnav/overrides.h"
#include "tools/polnav/run_output.h"
#include "tools/testbed/input_error.h"

namespace polnav::testbed {

int Run(const RunArguments& arguments, const Console& console, const ClosedLoop& closed_loop) {
  const sim::Level level =
      arguments.level == "measurement" ? sim::Level::kMeasurement : sim::Level::kImage;
  if (level == sim::Level::kMeasurement && !arguments.record.empty()) {
    throw InputError("--record " + arguments.record, 0, "",
                     "a recording holds pictures, which --level measurement does not draw");
  }
  const Scenario scenario = LoadScenario(
      arguments.scenario,
      OverridesOf(arguments.set, arguments.seed, arguments.duration_s, arguments.estimators),
      level);
  const std::filesystem::path stem = std::filesystem::path(arguments.scenario).stem();
  OutputFolder folder(arguments.out.empty() ? "out" / stem : std::filesystem::path(arguments.out));

  Progress progress(console, scenario.name, arguments.quiet);
  RunOptions options{.seed = scenario.seed,
                     .trial = 0,
                     .render_threads = arguments.render_threads,
                     .level = level,
                     .ground_truth_folder = {},
                     .record_folder = arguments.record};
  if (scenario.sensors.stereo && scenario.sensors.stereo->ground_truth) {
    options.ground_truth_folder = folder.path() / "ground_truth";
  }
  RunRecord record =
      closed_loop(scenario, options, [&](double fraction) { progress.Show(fraction); });
  progress.Finish();
  return Deliver({.scenario = scenario,
                  .record = std::move(record),
                  .level = arguments.level,
                  .command_line = arguments.command_line,
                  .quiet = arguments.quiet,
                  .json = arguments.json},
                 folder, console);
}

}  // namespace polnav::testbed
