// How long after a disturbance is an estimator as good again as it was before the first one?
//
// From the disturbance's end until, for a second,
//   heading   the error is no larger than 95 % of the errors before the first disturbance
//   tracking  every estimate says that it follows something
// or, where that does not come, until the next disturbance or the end of the run: a lower bound,
// and no promise where less than a second is left, which is not judged. An error that drifts, as a
// heading without a sky does, does not come back and says so.
#pragma once

#include <optional>
#include <vector>

#include "nav/api/estimate.h"
#include "tools/testbed/score.h"

namespace polnav::testbed {

// Nothing when no disturbance can be judged.
[[nodiscard]] std::optional<Recovery> ScoreRecovery(const std::vector<Stretch>& disturbed,
                                                    const ErrorSeries& errors,
                                                    const std::vector<nav::Estimate>& estimates);

}  // namespace polnav::testbed
