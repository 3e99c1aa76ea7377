#include "tools/testbed/study/study_run.h"

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "tools/testbed/input_error.h"
#include "tools/testbed/study/file_lock.h"
#include "tools/testbed/study/runner.h"
#include "tools/testbed/study/stop_gate.h"
#include "tools/testbed/study/study_stop.h"
#include "tools/testbed/study/study_table.h"

namespace polnav::testbed {
namespace {

// Of this process's share, those not yet done, in order.
class Queue {
 public:
  Queue(std::vector<bool> finished, const Shard& shard)
      : finished_(std::move(finished)), shard_(shard) {}

  std::optional<std::uint64_t> Next() {
    for (; next_ < finished_.size(); ++next_) {
      if (shard_.Holds(next_) && !finished_[next_]) return next_++;
    }
    return std::nullopt;
  }

  [[nodiscard]] StudyCounts Count() const {
    StudyCounts counts;
    for (std::uint64_t i = 0; i < finished_.size(); ++i) {
      if (!shard_.Holds(i)) continue;
      ++counts.total;
      if (finished_[i]) ++counts.resumed;
    }
    counts.done = counts.resumed;
    return counts;
  }

 private:
  std::vector<bool> finished_;
  Shard shard_;
  std::uint64_t next_ = 0;
};

WorkerLimits LimitsOf(const StudyPlan& plan) {
  return {.time_s = plan.options().time_limit_s, .memory_mb = plan.options().memory_limit_mb};
}

TrialFunction TrialOf(const StudyPlan& plan, const ClosedLoopFunction& closed_loop) {
  // Each worker process has its own copy, and fills it with what its trials share.
  auto motions = std::make_shared<sim::MotionMemory>();
  return [&plan, &closed_loop, motions](std::uint64_t trial) {
    return RunTrial(plan, trial, closed_loop, motions.get());
  };
}

// A part of a study does not see the trials before a look.
void CheckShard(const StudyPlan& plan, const StudyRunOptions& options) {
  if (plan.options().stop.empty() || options.shard.count == 1) return;
  throw InputError(options.study_file, 0, "stop",
                   fmt::format("a look sees all trials before it, and a shard ({} of {}) has only "
                               "its own: run the study without shards, or without stop",
                               options.shard.index == 0 ? options.shard.count : options.shard.index,
                               options.shard.count));
}

// Empty for a study without `stop`.
StopGate::Look LookOf(const StudyPlan& plan, StudyDatabase& database) {
  if (plan.options().stop.empty()) return {};
  return [&database](std::uint64_t samples) {
    bool enough = false;
    database.Guarded([&] { enough = LookAt(StudyTable(database.connection()), samples).Enough(); });
    return enough;
  };
}

std::uint64_t EndOf(const StudyPlan& plan, const StopGate& gate) {
  return *gate.ended_at() * plan.cases().size();
}

void MakeFolder(const std::filesystem::path& file) {
  std::error_code ignored;  // the lock says what is wrong
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
}

}  // namespace

StudyRunResult RunStudy(const StudyPlan& plan, const StudyRunOptions& options,
                        const ClosedLoopFunction& closed_loop,
                        const std::function<void(const StudyCounts&)>& progress) {
  CheckShard(plan, options);
  MakeFolder(options.out);
  FileLock lock(options.out);
  StudyDatabase database =
      StudyDatabase::Create(options.out, plan, options.study_file, options.mix_builds);
  const std::vector<bool> written = database.Finished(plan.trial_count(), options.retry_failed);
  Queue queue(written, options.shard);
  StudyRunResult result{.signal = 0, .counts = queue.Count(), .outcomes = {}, .digest = ""};
  StopGate gate(plan.cases().size(), written, LookOf(plan, database));

  // Trials that finish within a tenth of a second share a transaction.
  const auto write = [&] {
    for (auto records = gate.Take(); !records.empty(); records = gate.Take()) {
      database.Write(records);
      gate.Written(records);
    }
    progress(result.counts);
  };
  auto last_write = std::chrono::steady_clock::now();
  const RunnerHooks hooks{
      .next = [&] { return gate.ended_at() ? std::nullopt : queue.Next(); },
      .empty_record =
          [&](std::uint64_t trial) { return EmptyRecord(plan.At(trial), Outcome::kFailed, ""); },
      .finished =
          [&](TrialRecord record) {
            ++result.counts.done;
            if (record.outcome != Outcome::kOk) ++result.counts.failed;
            gate.Add(std::move(record));
          },
      .idle =
          [&] {
            const auto now = std::chrono::steady_clock::now();
            if (now - last_write < std::chrono::milliseconds(100)) return;
            last_write = now;
            write();
          },
      .in_child = [&] { lock.Forget(); },
      .enough = [&] { return gate.ended_at().has_value(); }};
  result.signal = Runner(TrialOf(plan, closed_loop), options.jobs, LimitsOf(plan), hooks).Run();
  write();
  if (gate.ended_at()) result.counts.done = result.counts.total = EndOf(plan, gate);
  result.outcomes = database.Outcomes();
  result.digest = database.Digest();
  database.Close();
  return result;
}

std::optional<TrialRecord> RerunTrial(const StudyPlan& plan, std::uint64_t trial,
                                      const ClosedLoopFunction& closed_loop) {
  std::optional<TrialRecord> result;
  bool started = false;
  const RunnerHooks hooks{
      .next = [&]() -> std::optional<std::uint64_t> {
        if (started) return std::nullopt;
        started = true;
        return trial;
      },
      .empty_record =
          [&](std::uint64_t t) { return EmptyRecord(plan.At(t), Outcome::kFailed, ""); },
      .finished = [&](TrialRecord record) { result = std::move(record); },
      .idle = [] {},
      .in_child = [] {}};
  const int signal = Runner(TrialOf(plan, closed_loop), 1, LimitsOf(plan), hooks).Run();
  return signal != 0 ? std::nullopt : result;
}

std::vector<std::string> DifferencesOf(const TrialRecord& record, const StoredTrial& stored) {
  std::vector<std::string> differences;
  if (record.outcome != stored.outcome) {
    differences.push_back(fmt::format("the outcome: {} then, {} now", NameOf(stored.outcome),
                                      NameOf(record.outcome)));
  }
  if (record.streams_sha256 != stored.streams_sha256) differences.emplace_back("the streams");
  for (const TrialScore& score : record.scores) {
    const auto then = stored.estimates_sha256.find(score.estimator);
    const bool same = then != stored.estimates_sha256.end() && then->second == score.sha256;
    if (!same) differences.push_back(fmt::format("estimates of {}", score.estimator));
  }
  if (differences.empty() && RecordSha256(record) != stored.record_sha256) {
    differences.emplace_back("the scores");
  }
  return differences;
}

}  // namespace polnav::testbed
