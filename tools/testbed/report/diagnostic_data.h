// What do the report's charts of the estimators' insides draw? Thinned; seconds and degrees.
#pragma once

#include "tools/testbed/option_tree.h"
#include "tools/testbed/run_record.h"
#include "tools/testbed/score.h"

namespace polnav::testbed {

// Null when the estimator follows no features.
[[nodiscard]] Json DiagnosticData(const Diagnostics& diagnostics);

// NEES of heading (1) and position (3) over time.
[[nodiscard]] Json NeesData(const ErrorSeries& series);

}  // namespace polnav::testbed
