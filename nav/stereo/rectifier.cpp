#include "nav/stereo/rectifier.h"

#include <Eigen/Geometry>
#include <cmath>
#include <opencv2/calib3d.hpp>

namespace polnav::nav {
namespace {

cv::Matx33d ToCv(const Eigen::Matrix3d& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}

// Rows of the virtual pair run along the baseline; it looks where both cameras look on average.
Eigen::Matrix3d VirtualAxes(const CameraCalibration& left, const CameraCalibration& right) {
  const Eigen::Vector3d x = (right.T_BC.p - left.T_BC.p).normalized();
  const Eigen::Vector3d forward =
      left.T_BC.q * Eigen::Vector3d::UnitZ() + right.T_BC.q * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d y = forward.cross(x).normalized();
  Eigen::Matrix3d R_BC;
  R_BC << x, y, x.cross(y);
  return R_BC;
}

// [Brown1971] in OpenCV's order k1 k2 p1 p2.
cv::Point2d BendRadTan(const cv::Vec4d& k, const cv::Point2d& p) {
  const double r2 = p.dot(p);
  const double radial = 1.0 + r2 * (k[0] + r2 * k[1]);
  return {p.x * radial + 2.0 * k[2] * p.x * p.y + k[3] * (r2 + 2.0 * p.x * p.x),
          p.y * radial + k[2] * (r2 + 2.0 * p.y * p.y) + 2.0 * k[3] * p.x * p.y};
}

// [Kannala2006, eq. 6].
cv::Point2d BendEquidistant(const cv::Vec4d& k, const cv::Point2d& p) {
  const double r = std::sqrt(p.dot(p));
  if (r < 1e-9) return p;
  const double theta = std::atan(r);
  const double t2 = theta * theta;
  const double bent = theta * (1.0 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3]))));
  return p * (bent / r);
}

}  // namespace

StereoRectifier::StereoRectifier(const StereoCalibration& calibration) {
  const auto& [left, right] = calibration;
  const Eigen::Matrix3d R_BC = VirtualAxes(left, right);
  camera_ = {.f_px = 0.5 * (left.fx_px + left.fy_px),
             .cx_px = left.cx_px,
             .cy_px = left.cy_px,
             .baseline_m = (right.T_BC.p - left.T_BC.p).norm(),
             .T_BC = {Eigen::Quaterniond(R_BC), left.T_BC.p}};
  const auto side = [&](const CameraCalibration& c) {
    return Side{.model = c.model,
                .intrinsics = {c.fx_px, 0, c.cx_px, 0, c.fy_px, c.cy_px, 0, 0, 1},
                .distortion = {c.distortion[0], c.distortion[1], c.distortion[2], c.distortion[3]},
                .rotation = ToCv(R_BC.transpose() * c.T_BC.q.toRotationMatrix())};
  };
  left_ = side(left);
  right_ = side(right);
}

std::vector<cv::Point2f> StereoRectifier::Rectify(const Side& side,
                                                  const std::vector<cv::Point2f>& raw) const {
  std::vector<cv::Point2f> rectified;
  if (raw.empty()) return rectified;
  const cv::Matx33d virtual_camera(camera_.f_px, 0, camera_.cx_px, 0, camera_.f_px, camera_.cy_px,
                                   0, 0, 1);
  if (side.model == DistortionModel::kEquidistant) {
    // Its ten Newton steps leave 1e-8 at any angle that a pinhole can still show.
    cv::fisheye::undistortPoints(raw, rectified, side.intrinsics, side.distortion, side.rotation,
                                 virtual_camera);
    return rectified;
  }
  // The distortion has no closed inverse; 1e-3 px is far below what tracking resolves.
  const cv::TermCriteria until(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 20, 1e-3);
  cv::undistortPoints(raw, rectified, side.intrinsics, side.distortion, side.rotation,
                      virtual_camera, until);
  return rectified;
}

std::vector<cv::Point2f> StereoRectifier::RectifyLeft(const std::vector<cv::Point2f>& raw) const {
  return Rectify(left_, raw);
}

std::vector<cv::Point2f> StereoRectifier::RectifyRight(const std::vector<cv::Point2f>& raw) const {
  return Rectify(right_, raw);
}

cv::Point2f StereoRectifier::RawRight(const cv::Point2f& rectified) const {
  const cv::Vec3d virtual_ray((rectified.x - camera_.cx_px) / camera_.f_px,
                              (rectified.y - camera_.cy_px) / camera_.f_px, 1.0);
  const cv::Vec3d ray = right_.rotation.t() * virtual_ray;
  const cv::Point2d straight(ray[0] / ray[2], ray[1] / ray[2]);
  const cv::Point2d bent = right_.model == DistortionModel::kEquidistant
                               ? BendEquidistant(right_.distortion, straight)
                               : BendRadTan(right_.distortion, straight);
  return {static_cast<float>(right_.intrinsics(0, 0) * bent.x + right_.intrinsics(0, 2)),
          static_cast<float>(right_.intrinsics(1, 1) * bent.y + right_.intrinsics(1, 2))};
}

}  // namespace polnav::nav
