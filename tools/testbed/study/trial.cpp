#include "tools/testbed/study/trial.h"

#include <chrono>
#include <cmath>
#include <limits>
#include <new>
#include <opencv2/core.hpp>

#include "tools/testbed/hash.h"
#include "tools/testbed/input_error.h"
#include "tools/testbed/memory_use.h"
#include "tools/testbed/result.h"
#include "tools/testbed/score.h"
#include "tools/testbed/yaml_document.h"

namespace polnav::testbed {
namespace {

// Finite numbers at the leaves, by their dotted paths.
void Flatten(const Json& tree, const std::string& path,
             std::vector<std::pair<std::string, double>>& metrics) {
  if (tree.is_object()) {
    for (const auto& [key, item] : tree.items()) Flatten(item, JoinKey(path, key), metrics);
  } else if (tree.is_number() && std::isfinite(tree.get<double>())) {
    metrics.emplace_back(path, tree.get<double>());
  }
}

// Wall time and memory differ from run to run; no verdict about them is a result.
bool IsOfTheMachine(const std::string& metric) {
  return metric == "wall_s" || metric == "real_time_factor" || metric == "peak_rss_mb" ||
         metric.starts_with("timing_ms.");
}

TrialScore RunScore(const Scenario& scenario, const Json& result) {
  TrialScore score;
  score.metrics.emplace_back("sim_duration_s", result["sim_duration_s"].get<double>());
  for (const auto& [name, stream] : result["streams"].items()) {
    score.metrics.emplace_back("streams." + name + ".count", stream["count"].get<double>());
  }
  if (result.contains("polarization_reading_deg")) {
    Flatten(result["polarization_reading_deg"], "polarization_reading_deg", score.metrics);
  }
  double passed = 0.0;
  double failed = 0.0;
  for (std::size_t i = 0; i < scenario.criteria.size(); ++i) {
    const Criterion& criterion = scenario.criteria[i];
    if (IsOfTheMachine(criterion.metric) || IsOfTheMachine(criterion.below)) continue;
    const Json& verdict = result["criteria"][i]["passed"];
    if (!verdict.is_boolean()) continue;  // about an estimator that was not run
    (verdict.get<bool>() ? passed : failed) += 1.0;
  }
  score.metrics.emplace_back("criteria.passed", passed);
  score.metrics.emplace_back("criteria.failed", failed);
  return score;
}

std::string StreamsSha256(const RunRecord& record) {
  Sha256 hash;
  for (const auto& [name, stream] : record.streams) {
    hash.Update(name);
    hash.UpdateValue(stream.count);
    hash.Update(stream.sha256);
  }
  return hash.HexDigest();
}

}  // namespace

TrialRecord EmptyRecord(const PlannedTrial& trial, Outcome outcome, const std::string& detail) {
  return {.trial = trial.trial,
          .case_id = trial.case_id,
          .sample = trial.sample,
          .inputs = trial.inputs,
          .outcome = outcome,
          .detail = detail,
          .streams_sha256 = "",
          .scores = {}};
}

TrialSeries SampleErrors(const ErrorSeries& errors, double duration_s, int points) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  TrialSeries series;
  series.heading_deg.assign(static_cast<std::size_t>(points), kNone);
  if (!errors.position_m.empty()) series.position_m = series.heading_deg;
  std::size_t next = 0;
  for (int k = 0; k < points; ++k) {
    const double t_s = duration_s * k / (points - 1);
    while (next < errors.t_s.size() && errors.t_s[next] <= t_s + 1e-9) ++next;
    if (next == 0) continue;
    const auto i = static_cast<std::size_t>(k);
    series.heading_deg[i] = static_cast<float>(errors.heading_deg[next - 1]);
    if (!series.position_m.empty()) {
      series.position_m[i] = static_cast<float>(errors.position_m[next - 1]);
    }
  }
  return series;
}

std::vector<TrialScore> ScoresOf(const Scenario& scenario, const RunRecord& record,
                                 std::uint64_t seed, int points) {
  const Json result = BuildResult(scenario, record, seed, "");
  const Trajectory truth = TrajectoryOf(record.truth);
  std::vector<TrialScore> scores{RunScore(scenario, result)};
  for (const EstimatorRun& run : record.estimators) {
    TrialScore& score = scores.emplace_back();
    score.estimator = run.name;
    score.sha256 = run.sha256;
    Flatten(result["estimators"][run.name], "", score.metrics);
    if (points == 0) continue;
    score.series = SampleErrors(ComputeErrors(truth, run.estimates, run.heading_only),
                                record.sim_duration_s, points);
  }
  return scores;
}

TrialRecord RunTrial(const StudyPlan& plan, std::uint64_t trial,
                     const ClosedLoopFunction& closed_loop, sim::MotionMemory* motions) {
  const auto begin = std::chrono::steady_clock::now();
  const PlannedTrial planned = plan.At(trial);
  TrialRecord record = EmptyRecord(planned, Outcome::kOk, "");
  const auto fail = [&](Outcome outcome, const char* detail) {
    record = EmptyRecord(planned, outcome, detail);
  };
  std::optional<Scenario> scenario;
  try {
    scenario = plan.ScenarioOf(planned);
  } catch (const InputError& error) {
    fail(Outcome::kInvalid, error.what());
  }
  try {
    if (scenario) {
      const RunRecord run = closed_loop(*scenario,
                                        {.seed = plan.options().seed,
                                         .trial = planned.sample,
                                         .level = plan.level(),
                                         .motions = motions},
                                        {});
      const SeriesOptions& series = plan.options().series;
      const bool keep = planned.sample < static_cast<std::uint64_t>(series.samples);
      record.scores = ScoresOf(*scenario, run, plan.options().seed, keep ? series.points : 0);
      record.streams_sha256 = StreamsSha256(run);
    }
  } catch (const std::bad_alloc&) {
    fail(Outcome::kOutOfMemory, "out of memory");
  } catch (const cv::Exception& error) {
    fail(error.code == cv::Error::StsNoMem ? Outcome::kOutOfMemory : Outcome::kFailed,
         error.what());
  } catch (const std::exception& error) {
    fail(Outcome::kFailed, error.what());
  }
  record.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  record.peak_rss_mb = PeakMemoryMb();
  return record;
}

}  // namespace polnav::testbed
