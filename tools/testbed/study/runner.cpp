#include "tools/testbed/study/runner.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>

namespace polnav::testbed {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kIdle{100};
// From outside; a trial whose workers keep being killed is not tried for ever.
constexpr int kMaxKilled = 3;

}  // namespace

Runner::Runner(TrialFunction run, int jobs, const WorkerLimits& limits, RunnerHooks hooks)
    : run_(std::move(run)),
      limits_(limits),
      hooks_(std::move(hooks)),
      workers_(static_cast<std::size_t>(jobs)) {}

int Runner::Run() {
  StopSignals signals;
  while (true) {
    FillWorkers();
    if (!Busy()) return 0;
    Wait(signals);
    if (const int number = signals.Take()) {
      workers_.clear();  // kills them
      return number;
    }
    for (auto& worker : workers_) {
      if (worker) ReadResults(worker);
      if (worker) KillLate(worker);
    }
    hooks_.idle();
    if (hooks_.enough && hooks_.enough()) {
      workers_.clear();
      return 0;
    }
  }
}

void Runner::FillWorkers() {
  for (auto& worker : workers_) {
    if (worker && worker->trial()) continue;
    std::optional<std::uint64_t> trial;
    if (!again_.empty()) {
      trial = again_.front();
      again_.pop_front();
      worker.reset();  // a fresh one below
    } else if (!exhausted_) {
      trial = hooks_.next();
      exhausted_ = !trial;
    }
    if (!trial) continue;
    if (!worker) worker = std::make_unique<Worker>(run_, limits_, hooks_.in_child);
    begun_[*trial] = Clock::now();
    worker->Start(*trial);
  }
}

bool Runner::Busy() const {
  return std::any_of(workers_.begin(), workers_.end(),
                     [](const auto& worker) { return worker && worker->trial(); });
}

void Runner::Wait(const StopSignals& signals) {
  std::vector<pollfd> fds{{.fd = signals.fd(), .events = POLLIN, .revents = 0}};
  auto until = Clock::now() + kIdle;
  for (const auto& worker : workers_) {
    if (!worker) continue;
    fds.push_back({.fd = worker->fd(), .events = POLLIN, .revents = 0});
    if (worker->trial()) until = std::min(until, worker->deadline());
  }
  const auto wait = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
  (void)::poll(fds.data(), fds.size(), std::max<int>(0, static_cast<int>(wait.count())));
}

void Runner::ReadResults(std::unique_ptr<Worker>& worker) {
  std::optional<TrialRecord> record = worker->Read();
  if (record) {
    begun_.erase(record->trial);
    const bool repeat = record->outcome == Outcome::kOutOfMemory && !worker->fresh() &&
                        ++attempts_[record->trial].fresh == 1;
    if (record->outcome == Outcome::kOutOfMemory) {
      const std::uint64_t trial = record->trial;
      if (repeat) again_.push_back(trial);
      worker.reset();  // its heap is not to be trusted
    }
    if (!repeat) {
      attempts_.erase(record->trial);
      hooks_.finished(*std::move(record));
    }
  } else if (worker->ended()) {
    HandleDeath(worker);
  }
}

void Runner::KillLate(std::unique_ptr<Worker>& worker) {
  if (!worker->trial() || Clock::now() < worker->deadline()) return;
  const std::uint64_t trial = *worker->trial();
  worker.reset();
  Record(trial, Outcome::kTimeout, fmt::format("longer than {} s", limits_.time_s));
}

void Runner::HandleDeath(std::unique_ptr<Worker>& worker) {
  const WorkerEnd end = worker->Finish();
  if (worker->trial()) {
    HandleOutcome(*worker, end.out_of_memory ? Outcome::kOutOfMemory : Outcome::kCrashed,
                  end.detail, end.from_outside);
  }
  worker.reset();
}

void Runner::HandleOutcome(const Worker& worker, Outcome outcome, const std::string& detail,
                           bool from_outside) {
  const std::uint64_t trial = *worker.trial();
  Attempts& attempts = attempts_[trial];
  const bool repeat =
      from_outside ? ++attempts.killed < kMaxKilled : !worker.fresh() && ++attempts.fresh == 1;
  if (repeat) {
    again_.push_back(trial);
    return;
  }
  Record(trial, outcome, detail);
}

void Runner::Record(std::uint64_t trial, Outcome outcome, const std::string& detail) {
  TrialRecord record = hooks_.empty_record(trial);
  record.outcome = outcome;
  record.detail = detail;
  record.wall_s = std::chrono::duration<double>(Clock::now() - begun_[trial]).count();
  begun_.erase(trial);
  attempts_.erase(trial);
  hooks_.finished(std::move(record));
}

}  // namespace polnav::testbed
