#include "tools/testbed/dataset/calibration_yaml.h"

#include <fmt/format.h>

#include <algorithm>

namespace polnav::testbed {
namespace {

constexpr double kHugest = 1e6;
constexpr OptionRange kSigma{.min = 0.0, .max = kHugest};
constexpr OptionRange kPositive{.min = 1e-9, .max = 1e9};

Json MatrixYaml(const Eigen::MatrixXd& matrix) {
  Json data = Json::array();
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index col = 0; col < matrix.cols(); ++col) data.push_back(matrix(row, col));
  }
  return {{"cols", matrix.cols()}, {"rows", matrix.rows()}, {"data", data}};
}

Json Common(const char* sensor_type, const char* comment, const nav::Pose& T_BS, double rate_hz) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = T_BS.q.toRotationMatrix();
  matrix.topRightCorner<3, 1>() = T_BS.p;
  return {{"sensor_type", sensor_type},
          {"comment", comment},
          {"T_BS", MatrixYaml(matrix)},
          {"q_BS_xyzw", {T_BS.q.x(), T_BS.q.y(), T_BS.q.z(), T_BS.q.w()}},
          {"rate_hz", rate_hz}};
}

Json ToYamlTree(const nav::CameraCalibration& c, double rate_hz) {
  const bool fisheye = c.model == nav::DistortionModel::kEquidistant;
  Json yaml = Common("camera", "x right, y down, z forward", c.T_BC, rate_hz);
  yaml["resolution"] = {c.width_px, c.height_px};
  yaml["camera_model"] = "pinhole";
  yaml["intrinsics"] = {c.fx_px, c.fy_px, c.cx_px, c.cy_px};
  yaml["distortion_model"] = fisheye ? "equidistant" : "radial-tangential";
  yaml["distortion_coefficients"] = c.distortion;
  return yaml;
}

Json ToYamlTree(const nav::ImuCalibration& c) {
  Json yaml = Common("imu", "means over the interval that ends at the stamp", c.T_BI, c.rate_hz);
  yaml["gyroscope_noise_density"] = c.gyro_noise_rad_s_sqrt_hz;
  yaml["gyroscope_random_walk"] = c.gyro_bias_walk_rad_s_sqrt_s;
  yaml["accelerometer_noise_density"] = c.accel_noise_m_s2_sqrt_hz;
  yaml["accelerometer_random_walk"] = c.accel_bias_walk_m_s2_sqrt_s;
  yaml["gyro_bias_sigma_rad_s"] = c.gyro_bias_sigma_rad_s;
  yaml["accel_bias_sigma_m_s2"] = c.accel_bias_sigma_m_s2;
  yaml["gyro_bias_instability_rad_s"] = c.gyro_bias_instability_rad_s;
  yaml["accel_bias_instability_m_s2"] = c.accel_bias_instability_m_s2;
  return yaml;
}

Json ToYamlTree(const nav::PolarimeterCalibration& c, double rate_hz) {
  Json yaml = Common("polarimeter", "z along the line of sight", c.T_BS, rate_hz);
  yaml["fov_rad"] = c.fov_rad;
  return yaml;
}

Json ToYamlTree(const nav::PolarizationCameraCalibration& c, double rate_hz) {
  const bool fisheye = c.lens.model == nav::LensModel::kEquidistant;
  Json yaml = Common("polarization_camera", "x right, y down, z along the axis", c.T_BS, rate_hz);
  yaml["resolution"] = {c.width_px, c.height_px};
  yaml["bits"] = c.bits;
  yaml["camera_model"] = fisheye ? "equidistant" : "pinhole";
  yaml["intrinsics"] = {c.lens.focal_px, c.lens.focal_px, c.lens.center_px.x(),
                        c.lens.center_px.y()};
  yaml["polarizer_rad"] = c.polarizer_rad;
  yaml["gain"] = c.gain;
  yaml["offset"] = c.offset;
  yaml["full_well_e"] = c.full_well_e;
  yaml["read_noise_e"] = c.read_noise_e;
  yaml["gain_sigma"] = c.gain_sigma;
  yaml["offset_sigma"] = c.offset_sigma;
  yaml["polarizer_sigma_rad"] = c.polarizer_sigma_rad;
  yaml["mount_sigma_rad"] = c.mount_sigma_rad;
  yaml["focal_sigma"] = c.focal_sigma;
  yaml["center_sigma_px"] = c.center_sigma_px;
  if (c.covariance) yaml["covariance"] = MatrixYaml(*c.covariance);
  return yaml;
}

Json ToYamlTree(const nav::OpticalFlowCalibration& c) {
  Json yaml = Common("optical_flow", "z along the optical axis", c.T_BF, c.rate_hz);
  yaml["flow_noise_density"] = c.flow_noise_rad_s_sqrt_hz;
  yaml["flow_scale_sigma"] = c.flow_scale_sigma;
  yaml["mount_sigma_rad"] = c.mount_sigma_rad;
  yaml["range_sigma_m"] = c.range_sigma_m;
  yaml["range_min_m"] = c.range_min_m;
  yaml["range_max_m"] = c.range_max_m;
  return yaml;
}

std::array<double, 4> FourNumbers(const SensorSection& section, const std::string& key) {
  const std::vector<double> values = section.Numbers(key, 4);
  return {values[0], values[1], values[2], values[3]};
}

Eigen::Vector2i Resolution(const SensorSection& section) {
  constexpr double kMost = 16384.0;
  const std::vector<double> values = section.Numbers("resolution", 2);
  for (const double value : values) {
    if (value >= 16.0 && value <= kMost && value == std::floor(value)) continue;
    section.Fail("resolution",
                 fmt::format("{} is no number of pixels from 16 to {}", value, kMost));
  }
  return {static_cast<int>(values[0]), static_cast<int>(values[1])};
}

// fu, fv, cu, cv.
std::array<double, 4> Intrinsics(const SensorSection& section) {
  const std::array<double, 4> values = FourNumbers(section, "intrinsics");
  if (!(values[0] > 0.0) || !(values[1] > 0.0)) {
    section.Fail("intrinsics",
                 fmt::format("focal lengths are positive, got {} and {}", values[0], values[1]));
  }
  return values;
}

// Four, whatever follows being zero; none where the model is "none".
std::array<double, 4> Distortion(const SensorSection& section) {
  const std::string key = "distortion_coefficients";
  std::vector<double> values = section.AnyNumbers(key);
  if (values.size() < 4) {
    section.Fail(key, fmt::format("expected 4 numbers, got {}", values.size()));
  }
  const bool more =
      std::any_of(values.begin() + 4, values.end(), [](double value) { return value != 0.0; });
  if (more) section.Fail(key, "more than 4 coefficients are not supported");
  return {values[0], values[1], values[2], values[3]};
}

}  // namespace

std::vector<SensorYaml> SensorYamls(const nav::Rig& rig, const sim::SensorOptions& sensors) {
  std::vector<SensorYaml> files;
  if (rig.stereo) {
    files.push_back({"cam0", ToYamlTree(rig.stereo->left, sensors.stereo.value().rate_hz)});
    files.push_back({"cam1", ToYamlTree(rig.stereo->right, sensors.stereo.value().rate_hz)});
  }
  if (rig.imu) files.push_back({"imu0", ToYamlTree(*rig.imu)});
  if (rig.polarimeter) {
    files.push_back({"pol0", ToYamlTree(*rig.polarimeter, sensors.polarimeter.value().rate_hz)});
  }
  if (rig.polarization_camera) {
    files.push_back({"polcam0", ToYamlTree(*rig.polarization_camera,
                                           sensors.polarization_camera.value().rate_hz)});
  }
  if (rig.optical_flow) files.push_back({"flow0", ToYamlTree(*rig.optical_flow)});
  if (sensors.reference) {
    files.push_back({"ref0", Common("reference", "a GNSS/INS's own solution, T_WB", {},
                                    sensors.reference->rate_hz)});
  }
  return files;
}

nav::CameraCalibration CameraFrom(const SensorSection& section) {
  nav::CameraCalibration c;
  c.T_BC = section.MountPose();
  const Eigen::Vector2i size = Resolution(section);
  c.width_px = size.x();
  c.height_px = size.y();
  (void)section.Word("camera_model", {"pinhole"});
  const std::array<double, 4> intrinsics = Intrinsics(section);
  c.fx_px = intrinsics[0];
  c.fy_px = intrinsics[1];
  c.cx_px = intrinsics[2];
  c.cy_px = intrinsics[3];
  const std::string model = section.Word(
      "distortion_model", {"radial-tangential", "radtan", "equidistant", "fisheye", "none"});
  if (model == "equidistant" || model == "fisheye") c.model = nav::DistortionModel::kEquidistant;
  if (model != "none") c.distortion = Distortion(section);
  return c;
}

nav::ImuCalibration ImuFrom(const SensorSection& section) {
  nav::ImuCalibration c;
  c.T_BI = section.MountPose();
  c.rate_hz = section.Number("rate_hz", kPositive);
  c.gyro_noise_rad_s_sqrt_hz = section.Number("gyroscope_noise_density", kSigma);
  c.gyro_bias_walk_rad_s_sqrt_s = section.Number("gyroscope_random_walk", kSigma);
  c.accel_noise_m_s2_sqrt_hz = section.Number("accelerometer_noise_density", kSigma);
  c.accel_bias_walk_m_s2_sqrt_s = section.Number("accelerometer_random_walk", kSigma);
  c.gyro_bias_sigma_rad_s = section.NumberOr("gyro_bias_sigma_rad_s", 0.0, kSigma);
  c.accel_bias_sigma_m_s2 = section.NumberOr("accel_bias_sigma_m_s2", 0.0, kSigma);
  c.gyro_bias_instability_rad_s = section.NumberOr("gyro_bias_instability_rad_s", 0.0, kSigma);
  c.accel_bias_instability_m_s2 = section.NumberOr("accel_bias_instability_m_s2", 0.0, kSigma);
  return c;
}

nav::PolarimeterCalibration PolarimeterFrom(const SensorSection& section) {
  return {.T_BS = section.MountPose(),
          .fov_rad = section.Number("fov_rad", {.min = 0.0, .max = 3.2})};
}

nav::PolarizationCameraCalibration PolarizationCameraFrom(const SensorSection& section) {
  nav::PolarizationCameraCalibration c;
  c.T_BS = section.MountPose();
  const Eigen::Vector2i size = Resolution(section);
  c.width_px = size.x();
  c.height_px = size.y();
  if (c.width_px % 2 != 0 || c.height_px % 2 != 0) {
    section.Fail("resolution", "a mosaic's width and height are even");
  }
  c.bits = section.Integer("bits", 8, 16);
  const bool fisheye = section.Word("camera_model", {"pinhole", "equidistant"}) == "equidistant";
  c.lens.model = fisheye ? nav::LensModel::kEquidistant : nav::LensModel::kPinhole;
  const std::array<double, 4> intrinsics = Intrinsics(section);
  if (intrinsics[0] != intrinsics[1]) section.Fail("intrinsics", "a mosaic has one focal length");
  c.lens.focal_px = intrinsics[0];
  c.lens.center_px = {intrinsics[2], intrinsics[3]};
  c.polarizer_rad = FourNumbers(section, "polarizer_rad");
  c.gain = FourNumbers(section, "gain");
  if (!(*std::min_element(c.gain.begin(), c.gain.end()) > 0.0)) {
    section.Fail("gain", "gains are positive");
  }
  c.offset = FourNumbers(section, "offset");
  c.full_well_e = section.Number("full_well_e", kPositive);
  c.read_noise_e = section.Number("read_noise_e", kSigma);
  c.gain_sigma = section.NumberOr("gain_sigma", 0.0, kSigma);
  c.offset_sigma = section.NumberOr("offset_sigma", 0.0, kSigma);
  c.polarizer_sigma_rad = section.NumberOr("polarizer_sigma_rad", 0.0, kSigma);
  c.mount_sigma_rad = section.NumberOr("mount_sigma_rad", 0.0, kSigma);
  c.focal_sigma = section.NumberOr("focal_sigma", 0.0, kSigma);
  c.center_sigma_px = section.NumberOr("center_sigma_px", 0.0, kSigma);
  if (section.Has("covariance")) {
    const std::vector<double> values = section.Matrix("covariance", nav::kInstrumentErrors);
    c.covariance = Eigen::Map<const nav::InstrumentCovariance>(values.data()).transpose();
  }
  return c;
}

nav::OpticalFlowCalibration OpticalFlowFrom(const SensorSection& section) {
  nav::OpticalFlowCalibration c;
  c.T_BF = section.MountPose();
  c.rate_hz = section.Number("rate_hz", kPositive);
  c.flow_noise_rad_s_sqrt_hz = section.Number("flow_noise_density", kSigma);
  c.flow_scale_sigma = section.NumberOr("flow_scale_sigma", 0.0, kSigma);
  c.mount_sigma_rad = section.NumberOr("mount_sigma_rad", 0.0, kSigma);
  c.range_sigma_m = section.Number("range_sigma_m", kSigma);
  c.range_min_m = section.Number("range_min_m", kSigma);
  c.range_max_m = section.Number("range_max_m", kPositive);
  if (!(c.range_min_m < c.range_max_m)) {
    section.Fail("range_min_m",
                 fmt::format("{} m is not below range_max_m, {} m", c.range_min_m, c.range_max_m));
  }
  return c;
}

void CheckPair(const nav::StereoCalibration& stereo, const SensorSection& right) {
  const auto& [left, second] = stereo;
  if (left.width_px != second.width_px || left.height_px != second.height_px) {
    right.Fail("resolution",
               fmt::format("{} x {} px here, {} x {} px of cam0: a pair has one size",
                           second.width_px, second.height_px, left.width_px, left.height_px));
  }
  const Eigen::Vector3d baseline_C0 = left.T_BC.q.conjugate() * (second.T_BC.p - left.T_BC.p);
  const double length_m = baseline_C0.norm();
  if (!(length_m > 1e-4)) {
    right.Fail("T_BS", "cam0 and cam1 are in the same place: without a baseline nothing has depth");
  }
  if (!(baseline_C0.x() > 0.5 * length_m)) {
    right.Fail("T_BS", "cam1 has to be to the right of cam0");
  }
  const Eigen::Vector3d z_C0 = left.T_BC.q.conjugate() * (second.T_BC.q * Eigen::Vector3d::UnitZ());
  if (!(z_C0.z() > 0.5)) right.Fail("T_BS", "cam0 and cam1 look more than 60 degrees apart");
}

}  // namespace polnav::testbed
