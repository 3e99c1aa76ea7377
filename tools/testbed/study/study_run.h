// Run what is still missing of a study, on this machine.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tools/testbed/study/schema.h"
#include "tools/testbed/study/shard.h"
#include "tools/testbed/study/study_database.h"
#include "tools/testbed/study/trial.h"

namespace polnav::testbed {

struct StudyRunOptions {
  int jobs = 1;
  Shard shard;
  bool retry_failed = false;
  bool mix_builds = false;  // go on with a file whose trials other code has run
  std::filesystem::path out;
  std::string study_file;  // as typed
};

// Of this process's share.
struct StudyCounts {
  std::uint64_t total = 0;    // with `stop`, at most; when it has ended, those that count
  std::uint64_t done = 0;     // in the file or about to be
  std::uint64_t resumed = 0;  // of them, were there at the start
  std::uint64_t failed = 0;   // of those run now, not ok
};

struct StudyRunResult {
  int signal = 0;  // that stopped it; 0: complete
  StudyCounts counts;
  std::map<Outcome, std::uint64_t> outcomes;  // of all that is in the file
  std::string digest;
};

// progress: at least every 100 ms. Throws InputError.
[[nodiscard]] StudyRunResult RunStudy(const StudyPlan& plan, const StudyRunOptions& options,
                                      const ClosedLoopFunction& closed_loop,
                                      const std::function<void(const StudyCounts&)>& progress);

// One trial in a worker process, without any file. Nothing when a signal stopped it.
[[nodiscard]] std::optional<TrialRecord> RerunTrial(const StudyPlan& plan, std::uint64_t trial,
                                                    const ClosedLoopFunction& closed_loop);

// What differs between a trial and its record: "the streams", "estimates of stereo"; empty when
// they are byte-identical.
[[nodiscard]] std::vector<std::string> DifferencesOf(const TrialRecord& record,
                                                     const StoredTrial& stored);

}  // namespace polnav::testbed
