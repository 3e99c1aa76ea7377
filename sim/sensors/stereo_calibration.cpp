#include <Eigen/Geometry>

#include "sim/random.h"
#include "sim/sensors/stereo_camera.h"

namespace polnav::sim {
namespace {

using Sample = RandomStream::Sample;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Quaterniond SmallRotation(double sigma_deg, Sample& random) {
  const double sigma = nav::DegToRad(sigma_deg);
  const double x = sigma * random.Gaussian();
  const double y = sigma * random.Gaussian();
  const Vector3d turn(x, y, sigma * random.Gaussian());
  const double angle = turn.norm();
  if (angle == 0.0) return Quaterniond::Identity();
  return Quaterniond(Eigen::AngleAxisd(angle, turn / angle));
}

void DisturbIntrinsics(const StereoCalibrationErrorOptions& error, double share, Sample random,
                       nav::CameraCalibration& camera) {
  const double focal = share * error.focal_sigma_px * random.Gaussian();
  camera.fx_px += focal;
  camera.fy_px += focal;
  camera.cx_px += share * error.center_sigma_px * random.Gaussian();
  camera.cy_px += share * error.center_sigma_px * random.Gaussian();
  camera.distortion[0] += share * error.distortion_sigma * random.Gaussian();
  camera.distortion[1] += share * error.distortion_sigma * random.Gaussian();
  camera.distortion[2] += 0.1 * share * error.distortion_sigma * random.Gaussian();
  camera.distortion[3] += 0.1 * share * error.distortion_sigma * random.Gaussian();
}

}  // namespace

nav::StereoCalibration NominalStereo(const StereoCameraOptions& options) {
  nav::CameraCalibration left;
  left.width_px = options.width_px;
  left.height_px = options.height_px;
  left.fx_px = options.focal_px;
  left.fy_px = options.focal_px;
  left.cx_px = 0.5 * (options.width_px - 1);
  left.cy_px = 0.5 * (options.height_px - 1);
  if (options.model == "equidistant") {
    left.model = nav::DistortionModel::kEquidistant;
    left.distortion = {options.k1, options.k2, options.k3, options.k4};
  } else {
    left.distortion = {options.k1, options.k2, options.p1, options.p2};
  }
  Eigen::Matrix3d R_BC;  // columns: the camera's right, down and forward axes in B
  R_BC << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const Eigen::AngleAxisd pitch(nav::DegToRad(options.pitch_down_deg), Vector3d::UnitY());
  left.T_BC = {pitch * Quaterniond(R_BC), options.position_m};
  nav::CameraCalibration right = left;
  right.T_BC.p = left.T_BC * Vector3d(options.baseline_m, 0.0, 0.0);
  return {left, right};
}

nav::StereoCalibration DrawTrueStereo(const StereoCameraOptions& options, std::uint64_t seed,
                                      std::uint64_t trial) {
  const StereoCalibrationErrorOptions& error = options.calibration_error;
  const RandomStream stream(seed, trial, "stereo/calibration");
  nav::StereoCalibration truth = NominalStereo(options);
  for (nav::CameraCalibration* camera : {&truth.left, &truth.right}) {
    DisturbIntrinsics(error, 1.0, stream.At(0), *camera);
  }
  DisturbIntrinsics(error, error.relative_share, stream.At(1), truth.right);
  Sample random = stream.At(2);
  truth.left.T_BC.q = truth.left.T_BC.q * SmallRotation(error.mount_rotation_sigma_deg, random);
  const double baseline = options.baseline_m + error.baseline_sigma_m * random.Gaussian();
  const nav::Pose T_LR{SmallRotation(error.relative_rotation_sigma_deg, random),
                       Vector3d(baseline, 0.0, 0.0)};
  truth.right.T_BC = truth.left.T_BC * T_LR;
  return truth;
}

}  // namespace polnav::sim
