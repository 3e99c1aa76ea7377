// One trial of a study: what comes out of it?
//
// Load the scenario with the trial's values, run the closed loop with (seed of the study, sample),
// score. Whatever goes wrong short of the death of the process is an outcome.
#pragma once

#include <functional>

#include "tools/testbed/closed_loop.h"
#include "tools/testbed/score.h"
#include "tools/testbed/study/study_plan.h"
#include "tools/testbed/study/trial_record.h"

namespace polnav::testbed {

using ClosedLoopFunction = std::function<RunRecord(const Scenario&, const RunOptions&,
                                                   const std::function<void(double)>&)>;

// A record of this trial without results.
[[nodiscard]] TrialRecord EmptyRecord(const PlannedTrial& trial, Outcome outcome,
                                      const std::string& detail);

[[nodiscard]] TrialRecord RunTrial(const StudyPlan& plan, std::uint64_t trial,
                                   const ClosedLoopFunction& closed_loop,
                                   sim::MotionMemory* motions = nullptr);

// The scores of a run: metrics of result.json by estimator, hashes, errors over time (points: 0
// for none).
[[nodiscard]] std::vector<TrialScore> ScoresOf(const Scenario& scenario, const RunRecord& record,
                                               std::uint64_t seed, int points);

// The newest error at or before each of `points` instants of the run.
[[nodiscard]] TrialSeries SampleErrors(const ErrorSeries& errors, double duration_s, int points);

}  // namespace polnav::testbed
