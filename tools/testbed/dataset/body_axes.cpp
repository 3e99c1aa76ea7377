#include "tools/testbed/dataset/body_axes.h"

#include <Eigen/Core>

namespace polnav::testbed {

Eigen::Quaterniond RenamedAxes(const Eigen::Quaterniond& q_BC) {
  const Eigen::Vector3d forward_B = q_BC * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d up_B = -(q_BC * Eigen::Vector3d::UnitY());
  Eigen::Matrix3d best = Eigen::Matrix3d::Identity();
  double best_fit = best.col(0).dot(forward_B) + best.col(2).dot(up_B);
  for (int x = 0; x < 6; ++x) {
    for (int z = 0; z < 6; ++z) {
      if (x % 3 == z % 3) continue;
      const Eigen::Vector3d x_P = (x < 3 ? 1.0 : -1.0) * Eigen::Vector3d::Unit(x % 3);
      const Eigen::Vector3d z_P = (z < 3 ? 1.0 : -1.0) * Eigen::Vector3d::Unit(z % 3);
      const double fit = x_P.dot(forward_B) + z_P.dot(up_B);
      if (fit <= best_fit) continue;
      best_fit = fit;
      best << x_P, z_P.cross(x_P), z_P;
    }
  }
  return Eigen::Quaterniond(best);
}

BodyAxes::BodyAxes(const nav::Rig& rig, const nav::Pose& T_BS) {
  if (rig.stereo) T_BP_.q = RenamedAxes(rig.stereo->left.T_BC.q);
  T_SP_ = T_BS.Inverse() * T_BP_;
  renamed_ = true;
}

sim::Truth BodyAxes::Of(sim::Truth truth) const {
  if (!renamed_) return truth;
  truth.T_WB = truth.T_WB * T_SP_;
  truth.w_WB_B_rad_s = T_SP_.q.conjugate() * truth.w_WB_B_rad_s;
  return truth;
}

nav::ReferencePose BodyAxes::Of(nav::ReferencePose pose) const {
  if (renamed_) pose.T_WB = pose.T_WB * T_BP_;
  return pose;
}

void BodyAxes::Apply(nav::Rig& rig) const {
  if (!renamed_) return;
  const nav::Pose T_PB = T_BP_.Inverse();
  if (rig.stereo) rig.stereo->left.T_BC = T_PB * rig.stereo->left.T_BC;
  if (rig.stereo) rig.stereo->right.T_BC = T_PB * rig.stereo->right.T_BC;
  if (rig.imu) rig.imu->T_BI = T_PB * rig.imu->T_BI;
  if (rig.optical_flow) rig.optical_flow->T_BF = T_PB * rig.optical_flow->T_BF;
  if (rig.polarimeter) rig.polarimeter->T_BS = T_PB * rig.polarimeter->T_BS;
  if (rig.polarization_camera) {
    rig.polarization_camera->T_BS = T_PB * rig.polarization_camera->T_BS;
  }
}

}  // namespace polnav::testbed
