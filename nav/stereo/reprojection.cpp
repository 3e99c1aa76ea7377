#include "nav/stereo/reprojection.h"

#include <algorithm>
#include <cmath>

namespace polnav::nav {
namespace {

constexpr double kMinDepthRatio = 1e-3;        // of the target's depth over the host's
constexpr double kMinInverseDepth_1_m = 1e-5;  // 100 km: further is the same as infinity

}  // namespace

StereoPixel PixelOf(const FeatureObservation& feature) {
  StereoPixel pixel{.uv_px = feature.uv_left_px};
  if (feature.u_right_px) pixel.disparity_px = feature.uv_left_px.x() - *feature.u_right_px;
  return pixel;
}

Viewpoint ViewpointOf(const RectifiedCamera& camera, const Pose& T_WB) {
  return {.R_WC = (T_WB.q * camera.T_BC.q).toRotationMatrix(),
          .p_WB = T_WB.p,
          .arm_W = T_WB.q * camera.T_BC.p};
}

// The landmark in C of the target j, times its inverse depth in the host h, is finite up to
// infinity:
//   y = R_CjW (w - rho arm_j),  w = seen_h + rho (p_WBh - p_WBj),  seen_h = R_WCh m + rho arm_h
std::optional<Reprojection> Reproject(const RectifiedCamera& camera, const Viewpoint& host,
                                      const Viewpoint& target, const Eigen::Vector3d& landmark,
                                      const StereoPixel& seen, const PixelSigmas& sigmas) {
  const double rho = landmark.z();
  const Eigen::Vector3d m(landmark.x(), landmark.y(), 1.0);
  const Eigen::Vector3d seen_W = host.R_WC * m + rho * host.arm_W;
  const Eigen::Vector3d between_W = host.p_WB - target.p_WB;
  const Eigen::Vector3d w = seen_W + rho * between_W;
  const Eigen::Vector3d point = target.R_WC.transpose() * (w - rho * target.arm_W);
  if (point.z() < kMinDepthRatio) return std::nullopt;
  const double inv_z = 1.0 / point.z();
  const double x = point.x() * inv_z;
  const double y = point.y() * inv_z;
  const double fb_z = camera.f_px * camera.baseline_m * inv_z;
  const Eigen::Vector3d weights(1.0 / sigmas.position_px, 1.0 / sigmas.position_px,
                                seen.disparity_px ? 1.0 / sigmas.disparity_px : 0.0);

  Reprojection r;
  r.residual << seen.uv_px.x() - (camera.f_px * x + camera.cx_px),
      seen.uv_px.y() - (camera.f_px * y + camera.cy_px),
      seen.disparity_px.value_or(0.0) - fb_z * rho;
  r.residual.array() *= weights.array();

  Eigen::Matrix3d by_point;                                        // of the residual
  by_point << -camera.f_px * inv_z, 0.0, camera.f_px * x * inv_z,  //
      0.0, -camera.f_px * inv_z, camera.f_px * y * inv_z,          //
      0.0, 0.0, fb_z * rho * inv_z;
  by_point = weights.asDiagonal() * by_point;
  const Eigen::Matrix3d by_w = by_point * target.R_WC.transpose();

  // b Skew(a) = b x a, row by row.
  r.by_host.leftCols<3>() = rho * by_w;
  r.by_target.leftCols<3>() = -rho * by_w;
  for (int row = 0; row < 3; ++row) {
    const Eigen::Vector3d b = by_w.row(row);
    r.by_host.row(row).tail<3>() = seen_W.cross(b);
    r.by_target.row(row).tail<3>() = b.cross(w);
  }
  r.by_landmark.leftCols<2>() = by_w * host.R_WC.leftCols<2>();
  // seen_W is linear in rho through the arm; those of host and target differ only by the attitude
  // between them.
  r.by_landmark.col(2) = by_w * (host.arm_W + between_W - target.arm_W);
  r.by_landmark(2, 2) -= weights.z() * fb_z;
  return r;
}

Eigen::Vector3d LandmarkOf(const RectifiedCamera& camera, const StereoPixel& seen) {
  const double rho = seen.disparity_px.value_or(0.0) / (camera.f_px * camera.baseline_m);
  return {(seen.uv_px.x() - camera.cx_px) / camera.f_px,
          (seen.uv_px.y() - camera.cy_px) / camera.f_px, std::max(rho, kMinInverseDepth_1_m)};
}

Eigen::Matrix3d Skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return m;
}

Eigen::Quaterniond ExpRotation(const Eigen::Vector3d& theta) {
  const double angle = theta.norm();
  // Below 1e-8 rad the sine's cubic term is under the rounding of a double.
  const double scale = angle < 1e-8 ? 0.5 : std::sin(0.5 * angle) / angle;
  const Eigen::Vector3d v = scale * theta;
  return Eigen::Quaterniond(std::cos(0.5 * angle), v.x(), v.y(), v.z()).normalized();
}

Eigen::Vector3d LogRotation(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d v = sign * q.vec();
  const double sine = v.norm();
  const double scale = sine < 1e-8 ? 2.0 : 2.0 * std::atan2(sine, sign * q.w()) / sine;
  return scale * v;
}

Pose Perturb(const Pose& T_WB, const Eigen::Matrix<double, 6, 1>& delta) {
  return {(ExpRotation(delta.tail<3>()) * T_WB.q).normalized(), T_WB.p + delta.head<3>()};
}

Eigen::Matrix<double, 6, 1> Difference(const Pose& pose, const Pose& reference) {
  Eigen::Matrix<double, 6, 1> delta;
  delta << pose.p - reference.p, LogRotation(pose.q * reference.q.conjugate());
  return delta;
}

}  // namespace polnav::nav
