#include <fmt/format.h>
#include <sched.h>

#include <algorithm>
#include <csignal>
#include <filesystem>

#include "tools/polnav/commands.h"
#include "tools/polnav/study_progress.h"
#include "tools/testbed/input_error.h"
#include "tools/testbed/study/study_run.h"

namespace polnav::testbed {
namespace {

namespace fs = std::filesystem;

// Processors that this process may use: of a container or a Slurm task, not of the machine.
int ProcessorCount() {
  cpu_set_t set;
  return ::sched_getaffinity(0, sizeof(set), &set) == 0 ? std::max(1, CPU_COUNT(&set)) : 1;
}

Shard ShardOf(const StudyArguments& arguments) {
  if (arguments.shard) return ParseShard(*arguments.shard, "--shard " + *arguments.shard);
  return ShardFromEnvironment(ProcessEnvironment).value_or(Shard{});
}

fs::path OutOf(const StudyArguments& arguments, const Shard& shard) {
  if (!arguments.out.empty()) return arguments.out;
  const std::string stem = fs::path(arguments.study).stem().string();
  if (shard.count == 1) return fs::path("out") / (stem + ".sqlite");
  // The last of N is N, not 0, as on the command line.
  const std::uint64_t index = shard.index == 0 ? shard.count : shard.index;
  return fs::path("out") / fmt::format("{}.{}-of-{}.sqlite", stem, index, shard.count);
}

std::string OutcomeTable(const std::map<Outcome, std::uint64_t>& outcomes) {
  std::string text;
  for (const auto& [outcome, count] : outcomes) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, NameOf(outcome));
  }
  return text.empty() ? "no trials" : text;
}

void Summarize(const StudyRunResult& result, const fs::path& out, const Console& console) {
  console.out << fmt::format("{}\n  {} of {} trials: {}\n  aggregate {}\n", out.string(),
                             result.counts.done, result.counts.total, OutcomeTable(result.outcomes),
                             result.digest);
}

int RunAll(const StudyArguments& arguments, const StudyPlan& plan, const Shard& shard,
           const fs::path& out, const Console& console, const ClosedLoop& closed_loop) {
  StudyProgress progress(console, plan.options().name, arguments.quiet);
  const StudyRunResult result =
      RunStudy(plan,
               {.jobs = arguments.jobs.value_or(ProcessorCount()),
                .shard = shard,
                .retry_failed = arguments.retry_failed,
                .mix_builds = arguments.mix_builds,
                .out = out,
                .study_file = arguments.study},
               closed_loop, [&](const StudyCounts& counts) { progress.Show(counts); });
  progress.Finish();
  if (result.signal != 0) {
    console.err << fmt::format(
        "polnav: stopped; {} of {} trials are in {}. The same command goes "
        "on from there\n",
        result.counts.done, result.counts.total, out.string());
    return 128 + result.signal;
  }
  if (!arguments.quiet) Summarize(result, out, console);
  // A part of a study is judged with the others, when they are joined.
  if (shard.count == 1) {
    return Report({.path = out.string(), .quiet = arguments.quiet}, console);
  }
  const bool all_ok = std::all_of(result.outcomes.begin(), result.outcomes.end(),
                                  [](const auto& of) { return of.first == Outcome::kOk; });
  if (arguments.quiet && !all_ok) {
    console.err << fmt::format("polnav: {}: {}\n", out.string(), OutcomeTable(result.outcomes));
  }
  return kExitHolds;
}

std::string TrialText(const StudyPlan& plan, const TrialRecord& record) {
  std::string text =
      fmt::format("trial {}: {}, sample {}: {}\n", record.trial, plan.cases()[record.case_id].label,
                  record.sample, NameOf(record.outcome));
  if (!record.detail.empty()) text += fmt::format("  {}\n", record.detail);
  for (const InputValue& value : record.inputs) {
    text += fmt::format("  {} = {}\n", value.key, value.text);
  }
  TextTable table({"", "heading RMSE deg", "position RMSE m", "estimates"});
  for (const TrialScore& score : record.scores) {
    if (score.estimator.empty()) continue;
    const auto metric = [&](const std::string& path) -> std::string {
      for (const auto& [name, value] : score.metrics) {
        if (name == path) return fmt::format("{:.4g}", value);
      }
      return "-";
    };
    table.Add({score.estimator, metric("heading_deg.rmse"), metric("position_m.rmse"),
               score.sha256.substr(0, 16)});
  }
  return record.scores.empty() ? text : text + table.Text();
}

int RunOne(const StudyArguments& arguments, const StudyPlan& plan, const fs::path& out,
           const Console& console, const ClosedLoop& closed_loop) {
  const std::uint64_t trial = *arguments.trial;
  if (trial >= plan.trial_count()) {
    throw InputError(fmt::format("--trial {}", trial), 0, "",
                     fmt::format("the study's {} trials are numbered from 0", plan.trial_count()));
  }
  std::optional<StoredTrial> stored;
  if (fs::exists(out)) {
    const StudyDatabase database = StudyDatabase::OpenToRead(out);
    database.CheckIdentity(plan);
    stored = database.Find(trial);
  }
  const std::optional<TrialRecord> record = RerunTrial(plan, trial, closed_loop);
  if (!record) return 128 + SIGINT;
  if (!arguments.quiet) console.out << TrialText(plan, *record);
  if (!stored) {
    if (!arguments.quiet) console.out << "  not recorded in " << out.string() << "\n";
    return kExitHolds;
  }
  const std::vector<std::string> differences = DifferencesOf(*record, *stored);
  if (differences.empty()) {
    if (!arguments.quiet) console.out << "  byte-identical with " << out.string() << "\n";
    return kExitHolds;
  }
  std::string text;
  for (const std::string& difference : differences) {
    text.append(text.empty() ? "" : "; ").append(difference);
  }
  console.err << fmt::format("polnav: trial {} differs from {}: {}\n", trial, out.string(), text);
  return kExitCriterionFailed;
}

}  // namespace

int Study(const StudyArguments& arguments, const Console& console, const ClosedLoop& closed_loop) {
  const StudyPlan plan = LoadStudy(arguments.study, arguments.trials, arguments.level);
  const Shard shard = ShardOf(arguments);
  const fs::path out = OutOf(arguments, shard);
  if (arguments.trial) return RunOne(arguments, plan, out, console, closed_loop);
  return RunAll(arguments, plan, shard, out, console, closed_loop);
}

}  // namespace polnav::testbed
