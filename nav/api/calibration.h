// What does an estimator believe about its sensors?
//
// Values somebody calibrated: near the truth, never the truth. The simulator keeps its own.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "nav/api/geometry.h"
#include "nav/api/lens.h"

namespace polnav::nav {

// How a camera's lens bends the rays (x, y, 1), r^2 = x^2 + y^2, theta = atan r:
//   radtan       radial-tangential [Brown1971]: k1 k2 p1 p2 in OpenCV's order
//   equidistant  [Kannala2006] k1 k2 k3 k4: at theta (1 + k1 theta^2 + ... + k4 theta^8) from the
//                centre; OpenCV's "fisheye", Kalibr's "equidistant"
enum class DistortionModel { kRadTan, kEquidistant };

struct CameraCalibration {
  DistortionModel model = DistortionModel::kRadTan;
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;  // centre of the top left pixel is (0, 0)
  double cy_px = 0.0;
  std::array<double, 4> distortion{};  // of the model
  Pose T_BC;                           // camera frame: x right, y down, z forward
};

struct StereoCalibration {
  CameraCalibration left;
  CameraCalibration right;
};

// S: z along the line of sight, x and y as the polarizer angles are counted from x towards y.
struct PolarimeterCalibration {
  Pose T_BS;
  double fov_rad = 0.0;  // full cone
};

// Errors of an imaging polarimeter in this order: gains, relative (4); dark readings over full
// scale (4); polarizers [rad] (4); rotation vector of T_BS, in B [rad] (3); focal length, relative
// (1); optical axis on the sensor [px] (2).
inline constexpr int kInstrumentErrors = 18;
using InstrumentCovariance = Eigen::Matrix<double, kInstrumentErrors, kInstrumentErrors>;

// An imaging polarimeter: four polarizers over every 2x2 cell of pixels. S as in nav/api/lens.h.
// The four are counted row by row from the top left pixel.
struct PolarizationCameraCalibration {
  int width_px = 0;
  int height_px = 0;
  int bits = 8;  // what full scale means: 2^bits - 1
  Lens lens;
  Pose T_BS;
  std::array<double, 4> polarizer_rad{};  // from S's x towards its y
  std::array<double, 4> gain = {1.0, 1.0, 1.0, 1.0};
  std::array<double, 4> offset{};  // dark reading over full scale [-]
  double full_well_e = 10500.0;    // electrons at full scale: shot noise
  double read_noise_e = 2.5;
  // How far the values above may be off: one sigma.
  double gain_sigma = 0.0;    // of each gain [-]
  double offset_sigma = 0.0;  // of each dark reading, over full scale [-]
  double polarizer_sigma_rad = 0.0;
  double mount_sigma_rad = 0.0;  // of T_BS, about each axis
  double focal_sigma = 0.0;      // of the focal length, relative [-]
  double center_sigma_px = 0.0;  // of where the optical axis meets the sensor, along each side
  // All of these together, where it is known: it then stands for the sigmas, since a calibration
  // errs in combinations that it cannot tell apart.
  std::optional<InstrumentCovariance> covariance;
};

[[nodiscard]] inline InstrumentCovariance CovarianceOf(const PolarizationCameraCalibration& c) {
  if (c.covariance) return *c.covariance;
  Eigen::Matrix<double, kInstrumentErrors, 1> sigma;
  sigma << Eigen::Vector4d::Constant(c.gain_sigma), Eigen::Vector4d::Constant(c.offset_sigma),
      Eigen::Vector4d::Constant(c.polarizer_sigma_rad),
      Eigen::Vector3d::Constant(c.mount_sigma_rad), c.focal_sigma,
      Eigen::Vector2d::Constant(c.center_sigma_px);
  return sigma.cwiseAbs2().asDiagonal();
}

// One sigma of a kind, as a data sheet has it; each axis by itself.
struct ImuCalibration {
  Pose T_BI;
  double rate_hz = 0.0;
  // Continuous-time white noise: angle and velocity random walk.
  double gyro_noise_rad_s_sqrt_hz = 0.0;
  double accel_noise_m_s2_sqrt_hz = 0.0;
  // Bias from turn-on to turn-on.
  double gyro_bias_sigma_rad_s = 0.0;
  double accel_bias_sigma_m_s2 = 0.0;
  // In-run bias stability: the floor of the Allan deviation.
  double gyro_bias_instability_rad_s = 0.0;
  double accel_bias_instability_m_s2 = 0.0;
  // Random walk of the bias: rate and acceleration random walk.
  double gyro_bias_walk_rad_s_sqrt_s = 0.0;
  double accel_bias_walk_m_s2_sqrt_s = 0.0;
};

// A camera that looks down and measures image motion, with gyroscopes and a range finder beside it.
// F: z along the optical axis, x and y as the sample's angles are counted.
struct OpticalFlowCalibration {
  Pose T_BF;
  double rate_hz = 0.0;
  double flow_noise_rad_s_sqrt_hz = 0.0;  // white, of each axis of the flow over a textured ground
  double flow_scale_sigma = 0.0;          // of the focal length, relative [-]
  double mount_sigma_rad = 0.0;           // of T_BF, about each axis
  double range_sigma_m = 0.0;
  double range_min_m = 0.0;
  double range_max_m = 0.0;
};

// Whatever is absent, the vehicle does not carry.
struct Rig {
  std::optional<StereoCalibration> stereo;
  std::optional<PolarimeterCalibration> polarimeter;
  std::optional<PolarizationCameraCalibration> polarization_camera;
  std::optional<ImuCalibration> imu;
  std::optional<OpticalFlowCalibration> optical_flow;
};

}  // namespace polnav::nav
