#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "tools/polnav/commands.h"
#include "tools/polnav/run_summary.h"
#include "tools/testbed/input_error.h"
#include "tools/testbed/output_folder.h"
#include "tools/testbed/report.h"
#include "tools/testbed/result.h"
#include "tools/testbed/tum.h"

namespace polnav::testbed {
namespace {

std::vector<ScenarioOverride> OverridesOf(const RunArguments& a) {
  std::vector<ScenarioOverride> overrides;
  for (const std::string& set : a.set) overrides.push_back({set, "--set " + set});
  if (a.seed) {
    overrides.push_back({"seed=" + *a.seed, "--seed " + *a.seed});
  }
  if (a.duration_s) {
    overrides.push_back({"duration_s=" + *a.duration_s, "--duration " + *a.duration_s});
  }
  if (!a.estimators.empty()) {
    const std::string names = fmt::format("{}", fmt::join(a.estimators, ", "));
    overrides.push_back({"estimators.run=[" + names + "]", "--estimators " + names});
  }
  return overrides;
}

// result.json goes last: where it stands, everything else does.
void StageAll(const ReportInput& input, OutputFolder& folder) {
  folder.Stage("scenario.yaml", ResolvedYaml(input.scenario));
  folder.Stage("truth.tum", ToTum(TrajectoryOf(input.record.truth)));
  for (const EstimatorRun& run : input.record.estimators) {
    folder.Stage(run.name + ".tum", ToTum(TrajectoryOf(run.estimates)));
  }
  folder.Stage("junit.xml", JUnitXml(input.scenario, input.result, input.criteria));
  folder.Stage("report.html", HtmlReport(input));
  folder.Stage("result.json", input.result.dump(2) + "\n");
}

}  // namespace

int Run(const RunArguments& arguments, const Console& console, const ClosedLoop& closed_loop) {
  if (arguments.level != "image") {
    throw InputError("--level " + arguments.level, 0, "",
                     "not available; every sensor is simulated at level 'image'");
  }
  const Scenario scenario = LoadScenario(arguments.scenario, OverridesOf(arguments));
  const std::filesystem::path stem = std::filesystem::path(arguments.scenario).stem();
  OutputFolder folder(arguments.out.empty() ? "out" / stem : std::filesystem::path(arguments.out));

  Progress progress(console, scenario.name, arguments.quiet);
  RunOptions options{.seed = scenario.seed, .trial = 0, .render_threads = arguments.render_threads};
  if (scenario.sensors.stereo && scenario.sensors.stereo->ground_truth) {
    options.ground_truth_folder = folder.path() / "ground_truth";
  }
  const RunRecord record =
      closed_loop(scenario, options, [&](double fraction) { progress.Show(fraction); });
  progress.Finish();

  const Json result = BuildResult(scenario, record, scenario.seed, arguments.level);
  const std::vector<CriterionResult> criteria = EvaluateCriteria(scenario, result);
  StageAll({scenario, record, result, criteria, arguments.command_line}, folder);
  folder.Commit();

  if (arguments.json) {
    console.out << result.dump(2) << "\n";
  } else if (arguments.quiet) {
    console.err << FailureLines(criteria);
  } else {
    console.out << RunSummary(scenario, result, criteria)
                << "report: " << (folder.path() / "report.html").string() << "\n";
  }
  return AllPassed(criteria) ? kExitHolds : kExitCriterionFailed;
}

}  // namespace polnav::testbed
