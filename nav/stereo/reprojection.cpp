#include "nav/stereo/reprojection.h"

#include <algorithm>
#include <cmath>

namespace polnav::nav {
namespace {

constexpr double kMinDepthRatio = 1e-3;        // of the target's depth over the host's
constexpr double kMinInverseDepth_1_m = 1e-5;  // 100 km: further is the same as infinity

// The landmark in C of keyframe j, times its inverse depth in the host: finite up to infinity.
//   y = R_CB (R_WBj^T w - rho p_BC),  w = R_WBh (R_BC m + rho p_BC) + rho (p_WBh - p_WBj)
struct Transfer {
  Eigen::Matrix3d R_CW;   // of the target
  Eigen::Matrix3d R_WCh;  // of the host
  Eigen::Vector3d arm_W;  // R_WBh (R_BC m + rho p_BC): the point seen from the host's body
  Eigen::Vector3d w;
  Eigen::Vector3d y;
};

Transfer TransferLandmark(const RectifiedCamera& camera, const Pose& T_WBh, const Pose& T_WBj,
                          const Eigen::Vector3d& landmark) {
  const double rho = landmark.z();
  const Eigen::Vector3d m(landmark.x(), landmark.y(), 1.0);
  const Eigen::Matrix3d R_BC = camera.T_BC.q.toRotationMatrix();
  const Eigen::Matrix3d R_WBh = T_WBh.q.toRotationMatrix();
  Transfer t;
  t.R_CW = (T_WBj.q.toRotationMatrix() * R_BC).transpose();
  t.R_WCh = R_WBh * R_BC;
  t.arm_W = R_WBh * (R_BC * m + rho * camera.T_BC.p);
  t.w = t.arm_W + rho * (T_WBh.p - T_WBj.p);
  t.y = t.R_CW * t.w - rho * (R_BC.transpose() * camera.T_BC.p);
  return t;
}

}  // namespace

StereoPixel PixelOf(const FeatureObservation& feature) {
  StereoPixel pixel{.uv_px = feature.uv_left_px};
  if (feature.u_right_px) pixel.disparity_px = feature.uv_left_px.x() - *feature.u_right_px;
  return pixel;
}

std::optional<Reprojection> Reproject(const RectifiedCamera& camera, const Pose& T_WBh,
                                      const Pose& T_WBj, const Eigen::Vector3d& landmark,
                                      const StereoPixel& seen, const PixelSigmas& sigmas) {
  const Transfer t = TransferLandmark(camera, T_WBh, T_WBj, landmark);
  if (t.y.z() < kMinDepthRatio) return std::nullopt;
  const double rho = landmark.z();
  const double inv_z = 1.0 / t.y.z();
  const double x = t.y.x() * inv_z;
  const double y = t.y.y() * inv_z;
  const double fb_z = camera.f_px * camera.baseline_m * inv_z;
  const Eigen::Vector3d weights(1.0 / sigmas.position_px, 1.0 / sigmas.position_px,
                                seen.disparity_px ? 1.0 / sigmas.disparity_px : 0.0);

  Reprojection r;
  r.residual << seen.uv_px.x() - (camera.f_px * x + camera.cx_px),
      seen.uv_px.y() - (camera.f_px * y + camera.cy_px),
      seen.disparity_px.value_or(0.0) - fb_z * rho;
  r.residual.array() *= weights.array();

  Eigen::Matrix3d by_y;                                        // of the residual
  by_y << -camera.f_px * inv_z, 0.0, camera.f_px * x * inv_z,  //
      0.0, -camera.f_px * inv_z, camera.f_px * y * inv_z,      //
      0.0, 0.0, fb_z * rho * inv_z;
  by_y = weights.asDiagonal() * by_y;
  const Eigen::Matrix3d by_w = by_y * t.R_CW;

  r.by_host.leftCols<3>() = rho * by_w;
  r.by_host.rightCols<3>() = -by_w * Skew(t.arm_W);
  r.by_target.leftCols<3>() = -rho * by_w;
  r.by_target.rightCols<3>() = by_w * Skew(t.w);
  r.by_landmark.leftCols<2>() = by_w * t.R_WCh.leftCols<2>();
  // arm_W is linear in rho through the lever arm; the lever arms of host and target differ only
  // by the attitude between them.
  const Eigen::Vector3d w_by_rho = T_WBh.q * camera.T_BC.p + T_WBh.p - T_WBj.p;
  r.by_landmark.col(2) = by_y * (t.R_CW * w_by_rho - camera.T_BC.q.conjugate() * camera.T_BC.p);
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
