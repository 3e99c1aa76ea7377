// What did the run yield, and did it keep its promises?
//
// result.json in the order of docs/architecture, the criteria evaluated on it, and JUnit XML for
// continuous integration. Wall times, memory and `real_time_factor` are the only entries that
// differ between two runs of the same scenario and seed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/testbed/option_tree.h"
#include "tools/testbed/run_record.h"
#include "tools/testbed/scenario.h"

namespace polnav::testbed {

// What "level" says of a recorded dataset.
inline constexpr const char* kReplayLevel = "replay";

enum class Verdict {
  kPassed,
  kFailed,
  kSkipped,  // about an estimator that the command line left out
};

struct CriterionResult {
  std::string name;
  std::string expected;          // for people: "estimators.stereo.ate_m.rmse <= 2"
  std::optional<double> actual;  // absent when the run did not yield the metric: then it failed
  Verdict verdict = Verdict::kFailed;
};

[[nodiscard]] std::vector<CriterionResult> EvaluateCriteria(const Scenario& scenario,
                                                            const Json& result);

// Everything of result.json, the criteria included.
[[nodiscard]] Json BuildResult(const Scenario& scenario, const RunRecord& record,
                               std::uint64_t seed, const std::string& level);

[[nodiscard]] bool AllPassed(const std::vector<CriterionResult>& criteria);

[[nodiscard]] std::string JUnitXml(const Scenario& scenario, const Json& result,
                                   const std::vector<CriterionResult>& criteria);

// & < > " ' as entities, and no control characters: for XML and HTML.
[[nodiscard]] std::string EscapeMarkup(const std::string& text);

}  // namespace polnav::testbed
