// How are many trials run at once, whatever they do?
//
// A number of workers, each with one trial at a time. A worker that dies, hangs or runs out of
// memory is replaced, and what it did becomes the trial's outcome. Only a fresh process counts:
// when a worker dies or runs out of memory that had run other trials before, the trial is
// repeated once in a new one, so that no outcome depends on what ran before it. A worker killed
// from outside says nothing of its trial, which is repeated too.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "tools/testbed/study/stop_signals.h"
#include "tools/testbed/study/worker.h"

namespace polnav::testbed {

struct RunnerHooks {
  // The next trial to run; nothing: no more.
  std::function<std::optional<std::uint64_t>()> next;
  // A trial without a result, to be filled with an outcome.
  std::function<TrialRecord(std::uint64_t trial)> empty_record;
  // In the order in which trials finish.
  std::function<void(TrialRecord)> finished;
  // At least every 100 ms.
  std::function<void()> idle;
  // First thing in every worker process.
  std::function<void()> in_child;
  // Asked after idle; true: trials that still run are given up. Never when empty.
  std::function<bool()> enough = {};
};

class Runner {
 public:
  Runner(TrialFunction run, int jobs, const WorkerLimits& limits, RunnerHooks hooks);

  // Returns the signal that stopped it, or 0 when all trials are done or enough of them. After a
  // signal no trial goes on, and what was unfinished counts as not begun.
  [[nodiscard]] int Run();

 private:
  // How often a trial has been repeated because a worker was not fresh, or was killed.
  struct Attempts {
    int fresh = 0;
    int killed = 0;
  };

  void FillWorkers();
  [[nodiscard]] bool Busy() const;
  void Wait(const StopSignals& signals);
  void ReadResults(std::unique_ptr<Worker>& worker);
  void KillLate(std::unique_ptr<Worker>& worker);
  void HandleDeath(std::unique_ptr<Worker>& worker);
  void HandleOutcome(const Worker& worker, Outcome outcome, const std::string& detail,
                     bool from_outside);
  void Record(std::uint64_t trial, Outcome outcome, const std::string& detail);

  TrialFunction run_;
  WorkerLimits limits_;
  RunnerHooks hooks_;
  std::vector<std::unique_ptr<Worker>> workers_;  // null: none, or one that must be replaced
  std::deque<std::uint64_t> again_;               // to run in fresh workers
  std::map<std::uint64_t, Attempts> attempts_;
  std::map<std::uint64_t, std::chrono::steady_clock::time_point> begun_;
  bool exhausted_ = false;
};

}  // namespace polnav::testbed
