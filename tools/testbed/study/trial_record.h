// What is left of a trial when it is over?
//
// Made in a worker process, sent to the one that keeps the result file (CBOR), written there as one
// transaction.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/testbed/option_tree.h"
#include "tools/testbed/study/dispersion.h"
#include "tools/testbed/study/schema.h"

namespace polnav::testbed {

// An estimator's errors at equal intervals; empty where none is kept.
struct TrialSeries {
  std::vector<float> heading_deg;
  std::vector<float> position_m;
};

struct TrialScore {
  std::string estimator;                                // empty: the run itself
  std::string sha256;                                   // hexadecimal; empty for the run itself
  std::vector<std::pair<std::string, double>> metrics;  // dotted paths; finite
  TrialSeries series;
};

struct TrialRecord {
  std::uint64_t trial = 0;
  std::size_t case_id = 0;
  std::uint64_t sample = 0;
  std::vector<InputValue> inputs;
  Outcome outcome = Outcome::kOk;
  std::string detail;          // for people
  std::string streams_sha256;  // hexadecimal; empty without a run
  std::vector<TrialScore> scores;
  // Of this machine at this hour; in no hash.
  double wall_s = 0.0;
  double peak_rss_mb = 0.0;
};

[[nodiscard]] std::string ToCbor(const TrialRecord& record);
[[nodiscard]] TrialRecord FromCbor(const std::string& bytes);

// Over everything but detail, wall time and memory: equal for equal trials.
[[nodiscard]] std::string RecordSha256(const TrialRecord& record);

}  // namespace polnav::testbed
