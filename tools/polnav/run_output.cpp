#include "tools/polnav/run_output.h"

#include "tools/polnav/command_line.h"
#include "tools/polnav/run_summary.h"
#include "tools/testbed/report.h"
#include "tools/testbed/result.h"
#include "tools/testbed/tum.h"

namespace polnav::testbed {
namespace {

std::string Tum(Trajectory trajectory, nav::TimeNs epoch) {
  for (StampedPose& pose : trajectory) pose.stamp += epoch;
  return ToTum(trajectory);
}

// Trajectories as the estimators gave them. result.json goes last: where it stands, everything else
// does.
void StageAll(const RunOutput& output, const ReportInput& report, OutputFolder& folder) {
  folder.Stage("scenario.yaml", ResolvedYaml(output.scenario));
  if (!output.record.truth.empty()) {
    folder.Stage("truth.tum", Tum(TrajectoryOf(output.record.truth), output.epoch));
  }
  for (const EstimatorRun& run : output.record.estimators) {
    folder.Stage(run.name + ".tum", Tum(TrajectoryOf(run.estimates), output.epoch));
  }
  folder.Stage("junit.xml", JUnitXml(output.scenario, report.result, report.criteria));
  folder.Stage("report.html", HtmlReport(report));
  folder.Stage("result.json", report.result.dump(2) + "\n");
}

}  // namespace

int Deliver(const RunOutput& output, OutputFolder& folder, const Console& console) {
  const RunRecord judged = AlignToTruth(output.record, output.alignment);
  const Json result = BuildResult(output.scenario, judged, output.scenario.seed, output.level);
  const std::vector<CriterionResult> criteria = EvaluateCriteria(output.scenario, result);
  StageAll(output, {output.scenario, judged, result, criteria, output.command_line}, folder);
  folder.Commit();
  if (output.json) {
    console.out << result.dump(2) << "\n";
  } else if (output.quiet) {
    console.err << FailureLines(criteria);
  } else {
    console.out << RunSummary(output.scenario, result, criteria)
                << "report: " << (folder.path() / "report.html").string() << "\n";
  }
  return AllPassed(criteria) ? kExitHolds : kExitCriterionFailed;
}

}  // namespace polnav::testbed
