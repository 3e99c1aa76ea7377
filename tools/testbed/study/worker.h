// How is a trial kept from taking the whole study down with it?
//
// A Worker is a child process, forked, that runs trials one after the other for as long as it
// lives: what trials share stays in its memory. It has a memory limit, leaves no core, ignores
// Ctrl-C (its parent decides), dies with its parent, and keeps what it says on stderr for the
// record of its crash. The process that forks must have no other threads.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/testbed/study/trial_record.h"

namespace polnav::testbed {

using TrialFunction = std::function<TrialRecord(std::uint64_t trial)>;

struct WorkerLimits {
  double time_s = 3600.0;  // of a trial, wall time
  double memory_mb = 4096.0;
};

// How a process ended.
struct WorkerEnd {
  bool out_of_memory = false;
  // By a signal that a person, a scheduler or the kernel sends: no fault of the trial's.
  bool from_outside = false;
  std::string detail;
};

class Worker {
 public:
  // in_child: called first in the new process, to let go of what only the parent may hold.
  Worker(const TrialFunction& run, const WorkerLimits& limits,
         const std::function<void()>& in_child);
  ~Worker();  // kills
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void Start(std::uint64_t trial);

  // To poll for reading.
  [[nodiscard]] int fd() const { return results_fd_; }
  [[nodiscard]] std::optional<std::uint64_t> trial() const { return trial_; }
  // Has run no trial before the present one.
  [[nodiscard]] bool fresh() const { return trials_started_ <= 1; }
  // When the present trial has had its time.
  [[nodiscard]] std::chrono::steady_clock::time_point deadline() const { return deadline_; }

  // Reads what is there; a record once one is complete. ended() is set when the process is gone.
  [[nodiscard]] std::optional<TrialRecord> Read();
  [[nodiscard]] bool ended() const { return ended_; }

  // Kills if need be, waits, and tells.
  [[nodiscard]] WorkerEnd Finish();

 private:
  [[noreturn]] void Serve(const TrialFunction& run, const WorkerLimits& limits, int tasks_fd,
                          int results_fd, pid_t parent) const;
  [[nodiscard]] std::string LastWords() const;

  pid_t pid_ = -1;
  int tasks_fd_ = -1;
  int results_fd_ = -1;
  int words_fd_ = -1;  // its stdout and stderr, in memory
  double time_limit_s_;
  std::uint64_t oom_kills_before_ = 0;
  std::optional<std::uint64_t> trial_;
  int trials_started_ = 0;
  std::chrono::steady_clock::time_point deadline_{};
  std::string received_;
  bool ended_ = false;
};

}  // namespace polnav::testbed
