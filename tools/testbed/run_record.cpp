#include "tools/testbed/run_record.h"

#include "tools/testbed/hash.h"

namespace polnav::testbed {

void OutcomeCounts::Add(const nav::Report& report) {
  used += report.outcome == nav::Outcome::kUsed ? 1 : 0;
  gated += report.outcome == nav::Outcome::kGated ? 1 : 0;
  unusable += report.outcome == nav::Outcome::kUnusable ? 1 : 0;
  ignored += report.outcome == nav::Outcome::kIgnored ? 1 : 0;
  keyframes += static_cast<std::uint64_t>(report.keyframes);
  features += static_cast<std::uint64_t>(report.features);
  inliers += static_cast<std::uint64_t>(report.inliers);
  flow_rejected += static_cast<std::uint64_t>(report.flow_rejected);
  pose_rejected += static_cast<std::uint64_t>(report.pose_rejected);
  map_rejected += static_cast<std::uint64_t>(report.map_rejected);
  imu_wrong += static_cast<std::uint64_t>(report.imu_wrong);
  pictures_wrong += static_cast<std::uint64_t>(report.pictures_wrong);
  gated_readings += static_cast<std::uint64_t>(report.gated_readings);
  returns += static_cast<std::uint64_t>(report.returns);
  failed_solves += static_cast<std::uint64_t>(report.failed_solves);
}

std::string HashOf(const std::vector<nav::Estimate>& estimates) {
  Sha256 hash;
  for (const nav::Estimate& e : estimates) {
    // Field by field: the padding of a struct is not part of the answer.
    hash.UpdateValue(e.stamp);
    hash.Update(e.T_WB.q.coeffs().data(), 4 * sizeof(double));
    hash.Update(e.T_WB.p.data(), 3 * sizeof(double));
    hash.Update(e.covariance.data(), 36 * sizeof(double));
    hash.UpdateValue(e.tracked);
    if (!e.biases) continue;
    hash.Update(e.biases->gyro_rad_s.data(), 3 * sizeof(double));
    hash.Update(e.biases->accel_m_s2.data(), 3 * sizeof(double));
    hash.Update(e.biases->covariance.data(), 36 * sizeof(double));
  }
  return hash.HexDigest();
}

RunRecord AlignToTruth(RunRecord record, Alignment alignment) {
  const Trajectory truth = TrajectoryOf(record.truth);
  for (EstimatorRun& run : record.estimators) {
    if (run.heading_only || alignment == Alignment::kNone) continue;
    const auto T_WE = Align(Associate(truth, TrajectoryOf(run.estimates)), alignment);
    if (!T_WE) continue;
    nav::Matrix6d turn = nav::Matrix6d::Zero();
    turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = T_WE->q.toRotationMatrix();
    for (nav::Estimate& e : run.estimates) {
      e.T_WB = *T_WE * e.T_WB;
      e.covariance = turn * e.covariance * turn.transpose();
    }
    run.alignment = alignment;
  }
  return record;
}

}  // namespace polnav::testbed
