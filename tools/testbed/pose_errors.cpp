#include "tools/testbed/pose_errors.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace polnav::testbed {
namespace {

struct Moments {
  Eigen::Vector3d mean_truth = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_estimate = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // truth (rows) with estimate (columns)
};

Moments MomentsOf(const std::vector<PosePair>& pairs) {
  const auto n = static_cast<double>(pairs.size());
  Moments m;
  for (const PosePair& pair : pairs) {
    m.mean_truth += pair.truth.p / n;
    m.mean_estimate += pair.estimate.p / n;
  }
  for (const PosePair& pair : pairs) {
    m.covariance +=
        (pair.truth.p - m.mean_truth) * (pair.estimate.p - m.mean_estimate).transpose() / n;
  }
  return m;
}

std::optional<Eigen::Quaterniond> UmeyamaRotation(const Eigen::Matrix3d& covariance) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  // Rank 2 is the least that fixes a rotation (evo: more than one singular value above epsilon).
  if (svd.singularValues()[1] <= std::numeric_limits<double>::epsilon()) return std::nullopt;
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) signs.z() = -1.0;
  const Eigen::Matrix3d rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  return Eigen::Quaterniond(rotation);
}

// Maximizes sum of truth . Rz(yaw) estimate: the derivative vanishes at this atan2.
std::optional<Eigen::Quaterniond> YawRotation(const Eigen::Matrix3d& c) {
  const double sine = c(1, 0) - c(0, 1);
  const double cosine = c(0, 0) + c(1, 1);
  if (std::hypot(sine, cosine) <= std::numeric_limits<double>::epsilon()) return std::nullopt;
  return Eigen::Quaterniond(Eigen::AngleAxisd(std::atan2(sine, cosine), Eigen::Vector3d::UnitZ()));
}

}  // namespace

std::vector<PosePair> Associate(const Trajectory& truth, const Trajectory& estimate,
                                nav::TimeNs max_difference) {
  if (truth.empty() || estimate.empty()) return {};
  const bool truth_is_shorter = estimate.size() > truth.size();
  const Trajectory& shorter = truth_is_shorter ? truth : estimate;
  const Trajectory& longer = truth_is_shorter ? estimate : truth;
  std::vector<PosePair> pairs;
  for (const StampedPose& pose : shorter) {
    const StampedPose* other = NearestWithin(longer, pose.stamp, max_difference);
    if (other == nullptr) continue;
    const StampedPose& t = truth_is_shorter ? pose : *other;
    const StampedPose& e = truth_is_shorter ? *other : pose;
    pairs.push_back({e.stamp, t.T_WB, e.T_WB});
  }
  return pairs;
}

const char* NameOf(Alignment alignment) {
  switch (alignment) {
    case Alignment::kNone:
      return "none";
    case Alignment::kYaw:
      return "yaw";
    case Alignment::kSe3:
      return "se3";
  }
  return "";
}

std::optional<nav::Pose> Align(const std::vector<PosePair>& pairs, Alignment alignment) {
  if (alignment == Alignment::kNone) return nav::Pose{};
  if (pairs.empty()) return std::nullopt;
  const Moments m = MomentsOf(pairs);
  const std::optional<Eigen::Quaterniond> q =
      alignment == Alignment::kYaw ? YawRotation(m.covariance) : UmeyamaRotation(m.covariance);
  if (!q) return std::nullopt;
  return nav::Pose{*q, m.mean_truth - *q * m.mean_estimate};
}

std::vector<PosePair> Moved(const nav::Pose& T_WE, std::vector<PosePair> pairs) {
  for (PosePair& pair : pairs) pair.estimate = T_WE * pair.estimate;
  return pairs;
}

double RotationAngle(const Eigen::Quaterniond& q) {
  return 2.0 * std::atan2(q.vec().norm(), std::abs(q.w()));
}

std::vector<double> ApeTranslation(const std::vector<PosePair>& pairs) {
  std::vector<double> errors;
  for (const PosePair& pair : pairs) errors.push_back((pair.estimate.p - pair.truth.p).norm());
  return errors;
}

std::vector<double> ApeAngle(const std::vector<PosePair>& pairs) {
  std::vector<double> errors;
  for (const PosePair& pair : pairs) {
    errors.push_back(RotationAngle(pair.estimate.q.conjugate() * pair.truth.q));
  }
  return errors;
}

std::vector<std::pair<std::size_t, std::size_t>> PairsByPath(const std::vector<PosePair>& pairs,
                                                             double delta_m) {
  if (!(delta_m > 0.0)) throw std::logic_error("a pair's distance must be positive");
  std::vector<std::pair<std::size_t, std::size_t>> result;
  std::optional<std::size_t> previous;
  double path_m = 0.0;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    path_m += (pairs[i].estimate.p - pairs[i - 1].estimate.p).norm();
    if (path_m < delta_m) continue;
    if (previous) result.emplace_back(*previous, i);
    previous = i;
    path_m = 0.0;
  }
  return result;
}

RelativeErrors Rpe(const std::vector<PosePair>& pairs, double delta_m) {
  RelativeErrors errors;
  for (const auto& [i, j] : PairsByPath(pairs, delta_m)) {
    const nav::Pose truth_step = pairs[i].truth.Inverse() * pairs[j].truth;
    const nav::Pose estimate_step = pairs[i].estimate.Inverse() * pairs[j].estimate;
    const nav::Pose error = truth_step.Inverse() * estimate_step;
    errors.translation_m.push_back(error.p.norm());
    errors.angle_rad.push_back(RotationAngle(error.q));
  }
  return errors;
}

}  // namespace polnav::testbed
