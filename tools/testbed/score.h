// How good was this estimator in this run?
//
// ATE after SE(3) alignment (the shape of the trajectory); position and heading without any (where
// it believed to be); RPE over 1 m, 20 m and 100 m; consistency of what it said about its own
// errors. A compass answers a heading and nothing else: what is about positions is then absent.
// Degrees and metres, as reported. Headings are compass azimuths; an error is estimate minus truth,
// wrapped.
#pragma once

#include <optional>
#include <vector>

#include "nav/api/estimate.h"
#include "tools/testbed/pose_errors.h"
#include "tools/testbed/run_record.h"
#include "tools/testbed/statistics.h"

namespace polnav::testbed {

// Errors over time, one entry for each pair of truth and estimate; for the score and the charts.
struct ErrorSeries {
  std::vector<double> t_s;
  std::vector<double> heading_deg;                       // signed
  std::vector<std::optional<double>> heading_sigma_deg;  // as the estimator claims
  std::vector<double> position_m;                        // 3-D; empty for a compass
  std::vector<double> horizontal_m;
  std::vector<double> position_nees;  // empty when no covariance is positive definite
  std::vector<double> heading_nees;
};

// One-sigma of the compass heading by the covariance of a world-frame rotation [rad]. Nothing when
// it is not positive or the x axis is vertical.
[[nodiscard]] std::optional<double> HeadingSigma(const nav::Estimate& estimate);

[[nodiscard]] ErrorSeries ComputeErrors(const Trajectory& truth,
                                        const std::vector<nav::Estimate>& estimates,
                                        bool heading_only = false);

struct RpeScore {
  Statistics trans_m;
  Statistics rot_deg;
};

// Nothing when the trajectory has no pair of this distance.
[[nodiscard]] std::optional<RpeScore> ScoreRpe(const std::vector<PosePair>& pairs, double delta_m);

struct HeadingScore {
  double mean_abs = 0.0;
  double mean = 0.0;  // signed
  double rmse = 0.0;
  double std = 0.0;   // of the signed error
  double max = 0.0;   // of the magnitude
  double last = 0.0;  // of the magnitude, at the end of the run
};

[[nodiscard]] HeadingScore ScoreHeading(const std::vector<double>& signed_errors);

struct PositionScore {
  Statistics error;
  double horizontal_rmse = 0.0;
  double last = 0.0;  // at the end of the run: what a closed path fails to close by
};

// Squared error over its covariance; nothing when that is not positive definite.
[[nodiscard]] std::optional<double> NeesOf(const Eigen::Vector3d& error,
                                           const Eigen::Matrix3d& covariance);

// Mean normalized estimation error squared: 3 (position) and 1 (heading) when honest, larger when
// too sure of itself. Within: share of heading errors inside three sigma, 0.997 when honest.
struct Nees {
  std::optional<double> position;
  double heading = 0.0;
  double heading_within_3_sigma = 0.0;
};

// After disturbances; see recovery.h.
struct Recovery {
  std::optional<double> heading_s;  // the longest; absent without five seconds to compare with
  double tracking_s = 0.0;          // the longest
  int disturbances = 0;             // judged
};

struct EstimatorScore {
  std::optional<Statistics> ate_m;  // absent when the truth does not determine an alignment
  std::optional<RpeScore> rpe_1m;
  std::optional<RpeScore> rpe_20m;  // for what is too short for the next
  std::optional<RpeScore> rpe_100m;
  HeadingScore heading_deg;
  std::optional<PositionScore> position_m;
  std::optional<double> drift_percent;  // mean RPE over 100 m, of 100 m
  std::optional<Nees> nees;
  std::optional<Recovery> recovery;  // absent when no disturbance can be judged
  double tracked_fraction = 0.0;
};

// Nothing when no estimate belongs to any truth.
[[nodiscard]] std::optional<EstimatorScore> Score(const Trajectory& truth,
                                                  const std::vector<nav::Estimate>& estimates,
                                                  bool heading_only = false,
                                                  const std::vector<Stretch>& disturbed = {});

}  // namespace polnav::testbed
