// What does a study cost beside its trials, and how long does the report of a large one take?
//
// BM_StudyTrial: a trial whose run takes microseconds, through worker process, scoring and result
// file. "cpu_ms": of all processes, a trial. BM_StudyReport/N: everything `polnav report` does for
// N trials of two estimators with twelve metrics each; "peak_mb": of this process so far, so that
// it counts in a run of this benchmark alone:
//   build/release/polnav_study_bench --benchmark_filter=Report/1000000
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <fstream>
#include <sstream>

#include "tests/testbed/study/example_study.h"
#include "tests/testbed/study/study_fixture.h"
#include "tools/polnav/command_line.h"
#include "tools/testbed/memory_use.h"
#include "tools/testbed/study/study_run.h"

namespace polnav::testbed {
namespace {

double ProcessorTime_s() {
  double sum = 0.0;
  for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage use{};
    ::getrusage(who, &use);
    sum += static_cast<double>(use.ru_utime.tv_sec + use.ru_stime.tv_sec) +
           1e-6 * static_cast<double>(use.ru_utime.tv_usec + use.ru_stime.tv_usec);
  }
  return sum;
}

void BM_StudyTrial(benchmark::State& state) {
  constexpr int kTrials = 400;
  const StudyFolder folder;
  const StudyPlan plan =
      folder.Plan("trials: " + std::to_string(kTrials) +
                  "\ndispersions:\n  - {key: sky.max_dop, uniform: {min: 0.5, max: 0.9}}\n");
  const double begin_s = ProcessorTime_s();
  for (auto _ : state) {
    std::filesystem::remove(folder.File("r.sqlite"));
    (void)RunStudy(plan, {.jobs = static_cast<int>(state.range(0)), .out = folder.File("r.sqlite")},
                   DrawnRun, [](const StudyCounts&) {});
  }
  const auto trials = static_cast<double>(kTrials * state.iterations());
  state.counters["cpu_ms"] = 1e3 * (ProcessorTime_s() - begin_s) / trials;
  state.SetItemsProcessed(kTrials * state.iterations());
}
BENCHMARK(BM_StudyTrial)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

void BM_StudyReport(benchmark::State& state) {
  const StudyFolder folder;
  const std::string file = folder.File("large.sqlite");
  {
    SQLite::Database db(file, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    FillExampleStudy(db, {.trials = static_cast<std::uint64_t>(state.range(0)),
                          .series = false,
                          .more_metrics = static_cast<int>(state.range(1)) - 3});
  }
  const ClosedLoop none;
  const double begin_s = ProcessorTime_s();
  for (auto _ : state) {
    std::ostringstream out;
    // A criterion fails: one trial in fifty does not go ok.
    if (RunCommandLine({"report", file}, {out, out, false}, none) != kExitCriterionFailed) {
      state.SkipWithError(out.str().c_str());
    }
  }
  state.counters["cpu_s"] = (ProcessorTime_s() - begin_s) / static_cast<double>(state.iterations());
  state.counters["peak_mb"] = PeakMemoryMb();
}
BENCHMARK(BM_StudyReport)
    ->Args({10'000, 12})
    ->Args({1'000'000, 12})
    ->Args({1'000'000, 60})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace polnav::testbed
