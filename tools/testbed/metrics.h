// Which numbers does a run yield, and under which dotted path into result.json?
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/testbed/bias_errors.h"
#include "tools/testbed/option_tree.h"
#include "tools/testbed/score.h"

namespace polnav::testbed {

// What cannot be computed is null.
[[nodiscard]] Json ToJson(const Statistics& statistics);
[[nodiscard]] Json ToJson(const HeadingScore& heading);
[[nodiscard]] Json ToJson(const EstimatorScore& score);
[[nodiscard]] Json ToJson(const BiasScore& score);

// Of one estimator, without "estimators.<name>."; derived from ToJson(EstimatorScore), and
// ToJson(BiasScore) where it estimates its IMU's biases.
[[nodiscard]] std::vector<std::string> EstimatorMetrics(bool heading_only = false,
                                                        bool biases = true);

// Of a run with every known estimator. Streams and stages are named by the run itself.
[[nodiscard]] std::vector<std::string> AllMetrics();

// streams.<stream>.count and timing_ms.<stage>.median or .p99 pass whatever the name.
[[nodiscard]] bool IsMetric(const std::string& path);

// "stereo" of "estimators.stereo.ate_m.rmse"; empty when the metric is of no estimator.
[[nodiscard]] std::string EstimatorOfMetric(const std::string& path);

// The number at a dotted path; nothing when there is none.
[[nodiscard]] std::optional<double> MetricAt(const Json& result, const std::string& path);

}  // namespace polnav::testbed
