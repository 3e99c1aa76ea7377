// Is all that a study stops by known well enough, and why did it stop? (`stop:` of a study file)
//
// Looks are at the first 100 samples of each case, 125, 157, ... (statistics/stopping.h); a look
// sees what those trials yielded and nothing that ran ahead of it. So a study ends at the same
// trial whatever the number of jobs, the order in which trials finished, or interruptions.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/testbed/option_tree.h"
#include "tools/testbed/statistics/interval.h"
#include "tools/testbed/study/study_table.h"

namespace polnav::testbed {

// One thing that is to be known, in one case.
struct StopCheck {
  std::string label;  // of the case
  std::string what;   // "stereo heading_deg.rmse mean"
  Estimated actual;
  std::size_t n = 0;
  double half_width = 0.0;  // as judged: a share of the value where that was asked for
  double asked = 0.0;
  bool relative = false;
  bool known = false;
};

struct StopLook {
  std::uint64_t samples = 0;
  std::vector<StopCheck> checks;

  [[nodiscard]] bool Enough() const;
};

// What a look at the first `samples` of each case sees.
[[nodiscard]] StopLook LookAt(const StudyTable& table, std::uint64_t samples);

// Of a study with `stop`, from its file alone.
struct StudyStop {
  std::optional<std::uint64_t> stopped_at;  // samples of each case; nothing: goes on, or ran to its
                                            // last trial
  StopLook last;                            // the look at which it stopped, or the last one
};
// Nothing for a study without.
[[nodiscard]] std::optional<StudyStop> StopOf(const StudyTable& table);

// For the aggregate; null for a study without.
[[nodiscard]] Json ToJson(const std::optional<StudyStop>& stop);

// "stopped after 157 trials of each case, known well enough". From the aggregate's `stop`, not
// null.
[[nodiscard]] std::string StopReason(const Json& stop);
// The same with a line for each thing that is to be known; empty for null.
[[nodiscard]] std::string StopText(const Json& stop);

}  // namespace polnav::testbed
