// How far is a study, and how long will it take? A bar on a terminal, a line now and then
// otherwise.
#pragma once

#include <chrono>
#include <string>

#include "tools/polnav/console.h"
#include "tools/testbed/study/study_run.h"

namespace polnav::testbed {

// "120 of 400 trials, 2 failed, 830 an hour, 20 min left".
[[nodiscard]] std::string StudyProgressText(const StudyCounts& counts, double elapsed_s);

class StudyProgress {
 public:
  StudyProgress(const Console& console, std::string label, bool quiet);
  void Show(const StudyCounts& counts);
  void Finish();

 private:
  using Clock = std::chrono::steady_clock;

  const Console& console_;
  std::string label_;
  bool quiet_;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point shown_{};
  std::uint64_t shown_done_ = 0;
  bool any_ = false;
};

}  // namespace polnav::testbed
