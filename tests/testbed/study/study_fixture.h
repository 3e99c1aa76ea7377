// A study to test with: the example scenario, and a closed loop whose errors are drawn from the
// trial's own stream, in microseconds in place of minutes.
#pragma once

#include <string>

#include "tests/testbed/temporary_folder.h"
#include "tools/testbed/closed_loop.h"
#include "tools/testbed/scenario.h"
#include "tools/testbed/study/study_database.h"
#include "tools/testbed/study/study_plan.h"

namespace polnav::testbed {

// The lines that follow name, scenarios and level in most tests: four trials, two dispersions.
inline constexpr const char* kTwoDispersions = R"(trials: 4
seed: 5
dispersions:
  - key: sky.max_dop
    normal: {mean: 0.7, sigma: 0.05, min: 0.5, max: 0.9}
  - key: sensors.polarimeter.channel_sigma
    log_uniform: {min: 0.001, max: 0.01}
)";

class StudyFolder {
 public:
  StudyFolder();

  // Writes study.yaml: a head, and these lines.
  std::string WriteStudy(const std::string& lines, const std::string& name = "study.yaml") const;
  [[nodiscard]] StudyPlan Plan(const std::string& lines) const {
    return LoadStudy(WriteStudy(lines));
  }
  // What LoadStudy complains about, without the folder; "no error".
  [[nodiscard]] std::string ErrorOf(const std::string& lines) const;
  [[nodiscard]] std::string File(const std::string& name) const {
    return (folder_.path() / name).string();
  }

 private:
  TemporaryFolder folder_;
};

// Heading errors of a trial: drawn per (seed, trial, estimator), larger when the sky is less
// polarized.
[[nodiscard]] RunRecord DrawnRun(const Scenario& scenario, const RunOptions& options,
                                 const std::function<void(double)>& progress);

// Everything in a result file that must not depend on how it was made, as text: trials, inputs,
// scores and series in order, columns by name.
[[nodiscard]] std::string AggregateText(const std::string& file);

}  // namespace polnav::testbed
