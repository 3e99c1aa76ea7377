#include "tools/testbed/score.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "tools/testbed/recovery.h"

namespace polnav::testbed {
namespace {

constexpr double kDriftDistance_m = 100.0;

// An estimate with the truth of its instant.
struct Judged {
  PosePair pair;
  const nav::Estimate* estimate = nullptr;
};

std::vector<Judged> Judge(const Trajectory& truth, const std::vector<nav::Estimate>& estimates) {
  std::vector<Judged> judged;
  std::size_t next = 0;
  for (const PosePair& pair : Associate(truth, TrajectoryOf(estimates))) {
    while (estimates[next].stamp < pair.stamp) ++next;
    judged.push_back({pair, &estimates[next]});
  }
  return judged;
}

double MeanOf(const std::vector<double>& values) { return Summarize(values).mean; }

std::optional<Nees> ScoreNees(const ErrorSeries& series) {
  if (series.heading_nees.empty()) return std::nullopt;
  const auto within = std::count_if(series.heading_nees.begin(), series.heading_nees.end(),
                                    [](double nees) { return nees <= 9.0; });
  Nees nees{.heading = MeanOf(series.heading_nees),
            .heading_within_3_sigma =
                static_cast<double>(within) / static_cast<double>(series.heading_nees.size())};
  if (!series.position_nees.empty()) nees.position = MeanOf(series.position_nees);
  return nees;
}

void AddHeading(const Judged& judged, ErrorSeries& series) {
  const auto& [pair, estimate] = judged;
  const double heading_rad =
      nav::WrapPi(nav::CompassHeading(pair.estimate.q) - nav::CompassHeading(pair.truth.q));
  series.heading_deg.push_back(nav::RadToDeg(heading_rad));
  const std::optional<double> sigma_rad = HeadingSigma(*estimate);
  series.heading_sigma_deg.push_back(sigma_rad ? std::optional(nav::RadToDeg(*sigma_rad))
                                               : std::nullopt);
  if (sigma_rad) series.heading_nees.push_back(std::pow(heading_rad / *sigma_rad, 2));
}

void AddPosition(const Judged& judged, ErrorSeries& series) {
  const Eigen::Vector3d error_m = judged.pair.estimate.p - judged.pair.truth.p;
  series.position_m.push_back(error_m.norm());
  series.horizontal_m.push_back(error_m.head<2>().norm());
  if (const auto nees = NeesOf(error_m, judged.estimate->covariance.topLeftCorner<3, 3>())) {
    series.position_nees.push_back(*nees);
  }
}

ErrorSeries SeriesOf(const std::vector<Judged>& judged, bool heading_only) {
  ErrorSeries series;
  for (const Judged& j : judged) {
    series.t_s.push_back(nav::ToSeconds(j.pair.stamp));
    AddHeading(j, series);
    if (!heading_only) AddPosition(j, series);
  }
  return series;
}

void ScorePositions(const std::vector<PosePair>& pairs, const ErrorSeries& series,
                    EstimatorScore& score) {
  if (const std::optional<nav::Pose> T_WE = Align(pairs, Alignment::kSe3)) {
    score.ate_m = Summarize(ApeTranslation(Moved(*T_WE, pairs)));
  }
  score.rpe_1m = ScoreRpe(pairs, 1.0);
  score.rpe_20m = ScoreRpe(pairs, 20.0);
  score.rpe_100m = ScoreRpe(pairs, kDriftDistance_m);
  if (score.rpe_100m) score.drift_percent = score.rpe_100m->trans_m.mean / kDriftDistance_m * 100.0;
  score.position_m = {Summarize(series.position_m), Summarize(series.horizontal_m).rmse,
                      series.position_m.back()};
}

}  // namespace

std::optional<double> HeadingSigma(const nav::Estimate& estimate) {
  // heading = atan2(x, y) of the body's x axis; a rotation dtheta moves that axis by dtheta x axis.
  const Eigen::Vector3d x_W = estimate.T_WB.q * Eigen::Vector3d::UnitX();
  const double horizontal2 = x_W.head<2>().squaredNorm();
  if (horizontal2 < 1e-12) return std::nullopt;
  const Eigen::Vector3d gradient(x_W.z() * x_W.x() / horizontal2, x_W.z() * x_W.y() / horizontal2,
                                 -1.0);
  const double variance = gradient.dot(estimate.covariance.bottomRightCorner<3, 3>() * gradient);
  return variance > 0.0 ? std::optional(std::sqrt(variance)) : std::nullopt;
}

ErrorSeries ComputeErrors(const Trajectory& truth, const std::vector<nav::Estimate>& estimates,
                          bool heading_only) {
  return SeriesOf(Judge(truth, estimates), heading_only);
}

std::optional<RpeScore> ScoreRpe(const std::vector<PosePair>& pairs, double delta_m) {
  RelativeErrors errors = Rpe(pairs, delta_m);
  if (errors.translation_m.empty()) return std::nullopt;
  for (double& angle : errors.angle_rad) angle = nav::RadToDeg(angle);
  return RpeScore{Summarize(errors.translation_m), Summarize(errors.angle_rad)};
}

std::optional<double> NeesOf(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance) {
  const Eigen::LLT<Eigen::Matrix3d> llt(covariance);
  if (llt.info() != Eigen::Success) return std::nullopt;
  return error.dot(llt.solve(error));
}

HeadingScore ScoreHeading(const std::vector<double>& signed_errors) {
  const Statistics s = Summarize(signed_errors);
  double sum = 0.0;
  for (const double error : signed_errors) sum += std::abs(error);
  return {.mean_abs = sum / static_cast<double>(signed_errors.size()),
          .mean = s.mean,
          .rmse = s.rmse,
          .std = s.std,
          .max = std::max(std::abs(s.min), std::abs(s.max)),
          .last = std::abs(signed_errors.back())};
}

std::optional<EstimatorScore> Score(const Trajectory& truth,
                                    const std::vector<nav::Estimate>& estimates, bool heading_only,
                                    const std::vector<Stretch>& disturbed) {
  const std::vector<Judged> judged = Judge(truth, estimates);
  if (judged.empty()) return std::nullopt;
  std::vector<PosePair> pairs;
  double tracked = 0.0;
  for (const Judged& j : judged) {
    pairs.push_back(j.pair);
    tracked += j.estimate->tracked ? 1.0 : 0.0;
  }
  const ErrorSeries series = SeriesOf(judged, heading_only);
  EstimatorScore score;
  score.heading_deg = ScoreHeading(series.heading_deg);
  if (!heading_only) ScorePositions(pairs, series, score);
  score.nees = ScoreNees(series);
  score.recovery = ScoreRecovery(disturbed, series, estimates);
  score.tracked_fraction = tracked / static_cast<double>(judged.size());
  return score;
}

}  // namespace polnav::testbed
