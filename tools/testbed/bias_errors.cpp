#include "tools/testbed/bias_errors.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "nav/inertial/options.h"
#include "tools/testbed/statistics.h"

namespace polnav::testbed {
namespace {

constexpr nav::TimeNs kTogether = 10'000'000;  // as poses are; a bias wanders far more slowly

struct TriadError {
  Eigen::Vector3d error;
  Eigen::Matrix3d covariance;
};

std::optional<sim::ImuBias> TruthAt(const std::vector<sim::Truth>& truth, nav::TimeNs stamp) {
  const auto found =
      std::lower_bound(truth.begin(), truth.end(), stamp - kTogether,
                       [](const sim::Truth& t, nav::TimeNs at) { return t.stamp < at; });
  if (found == truth.end() || found->stamp > stamp + kTogether) return std::nullopt;
  return found->imu_bias;
}

std::optional<double> NeesOf(const TriadError& e) {
  const Eigen::LLT<Eigen::Matrix3d> llt(e.covariance);
  if (llt.info() != Eigen::Success) return std::nullopt;
  return e.error.dot(llt.solve(e.error));
}

TriadBiasScore ScoreTriad(const std::vector<TriadError>& errors, double unit) {
  const TriadError& last = errors.back();
  const Eigen::Array3d sigma = last.covariance.diagonal().array().cwiseMax(0.0).sqrt();
  const auto within = (last.error.array().abs() <= 3.0 * sigma).count();
  TriadBiasScore score{.last = last.error.norm() / unit,
                       .last_sigma = sigma.matrix().norm() / unit,
                       .within_3_sigma = static_cast<double>(within) / 3.0,
                       .nees_last = NeesOf(last)};
  std::vector<double> nees;
  for (const TriadError& e : errors) {
    if (const auto value = NeesOf(e)) nees.push_back(*value);
  }
  if (!nees.empty()) score.nees = Summarize(nees).mean;
  return score;
}

}  // namespace

std::optional<BiasScore> ScoreBiases(const std::vector<sim::Truth>& truth,
                                     const std::vector<nav::Estimate>& estimates) {
  std::vector<TriadError> gyro;
  std::vector<TriadError> accel;
  for (const nav::Estimate& e : estimates) {
    if (!e.biases) continue;
    const std::optional<sim::ImuBias> known = TruthAt(truth, e.stamp);
    if (!known) continue;
    gyro.push_back(
        {e.biases->gyro_rad_s - known->gyro_rad_s, e.biases->covariance.topLeftCorner<3, 3>()});
    accel.push_back(
        {e.biases->accel_m_s2 - known->accel_m_s2, e.biases->covariance.bottomRightCorner<3, 3>()});
  }
  if (gyro.empty()) return std::nullopt;
  return BiasScore{.gyro_deg_s = ScoreTriad(gyro, nav::DegToRad(1.0)),
                   .accel_mg = ScoreTriad(accel, 1e-3 * nav::kGravity_m_s2)};
}

}  // namespace polnav::testbed
