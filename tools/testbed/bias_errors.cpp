#include "tools/testbed/bias_errors.h"

#include <cmath>

#include "nav/inertial/options.h"
#include "tools/testbed/score.h"
#include "tools/testbed/statistics.h"
#include "tools/testbed/trajectory.h"

namespace polnav::testbed {
namespace {

struct TriadError {
  Eigen::Vector3d error;
  Eigen::Matrix3d covariance;
};

TriadBiasScore ScoreTriad(const std::vector<TriadError>& errors, double unit) {
  const TriadError& last = errors.back();
  const Eigen::Array3d sigma = last.covariance.diagonal().array().cwiseMax(0.0).sqrt();
  const auto within = (last.error.array().abs() <= 3.0 * sigma).count();
  TriadBiasScore score{.last = last.error.norm() / unit,
                       .last_sigma = sigma.matrix().norm() / unit,
                       .within_3_sigma = static_cast<double>(within) / 3.0,
                       .nees_last = NeesOf(last.error, last.covariance)};
  std::vector<double> nees;
  for (const TriadError& e : errors) {
    if (const auto value = NeesOf(e.error, e.covariance)) nees.push_back(*value);
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
    const sim::Truth* at = NearestWithin(truth, e.stamp, kTogether);
    if (at == nullptr || !at->imu_bias) continue;
    const sim::ImuBias& known = *at->imu_bias;
    gyro.push_back(
        {e.biases->gyro_rad_s - known.gyro_rad_s, e.biases->covariance.topLeftCorner<3, 3>()});
    accel.push_back(
        {e.biases->accel_m_s2 - known.accel_m_s2, e.biases->covariance.bottomRightCorner<3, 3>()});
  }
  if (gyro.empty()) return std::nullopt;
  return BiasScore{.gyro_deg_s = ScoreTriad(gyro, nav::DegToRad(1.0)),
                   .accel_mg = ScoreTriad(accel, 1e-3 * nav::kGravity_m_s2)};
}

}  // namespace polnav::testbed
