// Which finished trials count, and has the study run enough of them?
//
// A study with `stop` ends at a look that sees all trials before it and none behind it. What
// finishes behind the next look waits here, in memory, until that look is decided: it is then let
// through, or thrown away when the look ends the study. So no file ever holds a trial that ran
// ahead. Without `stop` everything passes at once.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "tools/testbed/study/trial_record.h"

namespace polnav::testbed {

class StopGate {
 public:
  // Whether the first `samples` of each case, all of which are written, are enough.
  using Look = std::function<bool(std::uint64_t samples)>;

  // written: of all trials, those in the file. Looks at once at what is there. look empty: no
  // `stop`.
  StopGate(std::uint64_t cases, std::vector<bool> written, Look look);

  void Add(TrialRecord record);
  // What may be written now; Written() must follow when it has been.
  [[nodiscard]] std::vector<TrialRecord> Take();
  // Decides the looks that are now complete.
  void Written(const std::vector<TrialRecord>& records);

  // Samples of each case at which the study ended; nothing when it goes on.
  [[nodiscard]] std::optional<std::uint64_t> ended_at() const { return ended_at_; }

 private:
  void DecideLooks();

  std::uint64_t cases_;
  std::vector<bool> written_;
  Look look_;
  std::uint64_t next_look_;       // samples
  std::uint64_t first_open_ = 0;  // the first trial that is not written
  std::optional<std::uint64_t> ended_at_;
  std::map<std::uint64_t, TrialRecord> waiting_;
};

}  // namespace polnav::testbed
