// Whatever a trial does to its process, the study goes on and records one outcome.
#include "tools/testbed/study/runner.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <thread>

#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

struct Course {
  int signal = 0;
  std::map<std::uint64_t, TrialRecord> records;
  int finished = 0;
};

Course RunAll(std::uint64_t trials, int jobs, const TrialFunction& trial,
              const WorkerLimits& limits = {}) {
  Course run;
  std::uint64_t next = 0;
  Runner runner(trial, jobs, limits,
                {.next = [&]() -> std::optional<std::uint64_t> {
                   if (next == trials) return std::nullopt;
                   return next++;
                 },
                 .empty_record = [](std::uint64_t t) { return TrialRecord{.trial = t}; },
                 .finished =
                     [&](TrialRecord record) {
                       ++run.finished;
                       run.records[record.trial] = std::move(record);
                     },
                 .idle = [] {},
                 .in_child = [] {}});
  run.signal = runner.Run();
  return run;
}

TrialRecord Fine(std::uint64_t trial) {
  return {.trial = trial, .sample = 7 * trial, .detail = std::to_string(::getpid())};
}

[[gnu::noinline]] void Crash() {
  ::signal(SIGSEGV, SIG_DFL);  // the sanitizers' own handler would exit instead
  ::raise(SIGSEGV);
}

void ExpectOthersFine(const Course& run, std::uint64_t trials, std::uint64_t culprit) {
  EXPECT_EQ(run.signal, 0);
  EXPECT_EQ(run.finished, static_cast<int>(trials)) << "each trial once";
  for (std::uint64_t i = 0; i < trials; ++i) {
    if (i == culprit) continue;
    ASSERT_TRUE(run.records.contains(i));
    EXPECT_EQ(run.records.at(i).outcome, Outcome::kOk) << i;
    EXPECT_EQ(run.records.at(i).sample, 7 * i);
  }
}

TEST(Runner, RunsEveryTrialOnceInProcessesOfItsOwn) {
  for (const int jobs : {1, 2, 5}) {
    const Course run = RunAll(40, jobs, Fine);
    ExpectOthersFine(run, 40, 40);
    std::map<std::string, int> processes;
    for (const auto& [trial, record] : run.records) ++processes[record.detail];
    EXPECT_LE(processes.size(), static_cast<std::size_t>(jobs)) << "workers serve many trials";
    EXPECT_FALSE(processes.contains(std::to_string(::getpid())));
  }
}

TEST(Runner, ASegmentationFaultIsOneOutcome) {
  for (const int jobs : {1, 2}) {
    const Course run = RunAll(8, jobs, [](std::uint64_t trial) {
      if (trial == 3) Crash();
      return Fine(trial);
    });
    ExpectOthersFine(run, 8, 3);
    EXPECT_EQ(run.records.at(3).outcome, Outcome::kCrashed);
    EXPECT_EQ(run.records.at(3).detail.substr(0, 9), "signal 11");
  }
}

TEST(Runner, AnExitIsOneOutcomeWithItsLastWords) {
  const Course run = RunAll(4, 2, [](std::uint64_t trial) {
    if (trial == 1) {
      std::fprintf(stderr, "no license\n");
      std::_Exit(5);
    }
    return Fine(trial);
  });
  ExpectOthersFine(run, 4, 1);
  EXPECT_EQ(run.records.at(1).outcome, Outcome::kCrashed);
  EXPECT_EQ(run.records.at(1).detail, "exit code 5: no license");
}

TEST(Runner, AHangIsOneOutcome) {
  const Course run = RunAll(6, 2,
                            [](std::uint64_t trial) {
                              while (trial == 2) ::pause();
                              return Fine(trial);
                            },
                            {.time_s = 0.3});
  ExpectOthersFine(run, 6, 2);
  EXPECT_EQ(run.records.at(2).outcome, Outcome::kTimeout);
  EXPECT_GE(run.records.at(2).wall_s, 0.3);
}

#if !defined(__SANITIZE_ADDRESS__)
TEST(Runner, RunningOutOfMemoryIsOneOutcome) {
  const auto greedy = [](std::uint64_t trial) {
    if (trial == 2) {
      std::vector<std::vector<char>> hoard;
      while (true) hoard.emplace_back(16 << 20, 'x');
    }
    return Fine(trial);
  };
  const Course run = RunAll(5, 2, greedy, {.memory_mb = 512.0});
  ExpectOthersFine(run, 5, 2);
  EXPECT_EQ(run.records.at(2).outcome, Outcome::kOutOfMemory);
}

// Nobody catches what a thread throws: the process dies, and its last words tell why.
TEST(Runner, RunningOutOfMemoryInAThreadIsTheSame) {
  const auto greedy = [](std::uint64_t trial) {
    if (trial == 0) {
      std::thread([] {
        std::vector<std::vector<char>> hoard;
        while (true) hoard.emplace_back(16 << 20, 'x');
      }).join();
    }
    return Fine(trial);
  };
  const Course run = RunAll(2, 1, greedy, {.memory_mb = 512.0});
  EXPECT_EQ(run.records.at(0).outcome, Outcome::kOutOfMemory) << run.records.at(0).detail;
}
#endif

// Fails only in a process that has run something before: in a fresh one the trial is fine, and
// that is what counts.
TEST(Runner, NoOutcomeDependsOnWhatRanBefore) {
  const Course run = RunAll(6, 1, [](std::uint64_t trial) {
    static int served = 0;
    if (++served > 2) Crash();
    return Fine(trial);
  });
  ExpectOthersFine(run, 6, 6);
}

TEST(Runner, AWorkerKilledFromOutsideSaysNothingOfItsTrial) {
  // Shared with the workers, so that each kill happens once.
  auto* const kills = static_cast<std::atomic<int>*>(::mmap(nullptr, sizeof(std::atomic<int>),
                                                            PROT_READ | PROT_WRITE,
                                                            MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  ASSERT_NE(kills, MAP_FAILED);
  const Course run = RunAll(4, 2, [&](std::uint64_t trial) {
    if (trial == 1 && kills->fetch_add(1) == 0) ::kill(::getpid(), SIGKILL);
    return Fine(trial);
  });
  ExpectOthersFine(run, 4, 4);
  EXPECT_EQ(kills->load(), 2) << "killed once, then run";
  ::munmap(kills, sizeof(std::atomic<int>));
}

TEST(Runner, ASignalStopsItAndLeavesNoProcess) {
  for (const int number : {SIGINT, SIGTERM}) {
    int finished = 0;
    Runner runner(
        [](std::uint64_t trial) {
          while (trial > 0) ::pause();
          return Fine(trial);
        },
        2, {},
        {.next = [next = std::uint64_t{0}]() mutable { return std::optional(next++); },
         .empty_record = [](std::uint64_t t) { return TrialRecord{.trial = t}; },
         .finished =
             [&](const TrialRecord&) {
               ++finished;
               ::kill(::getpid(), number);  // held back, and found at the next look
             },
         .idle = [] {},
         .in_child = [] {}});
    EXPECT_EQ(runner.Run(), number);
    EXPECT_EQ(finished, 1);
    EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "no child is left";
  }
}

}  // namespace
}  // namespace polnav::testbed
