#include "tools/testbed/camera_file.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

std::array<double, 4> Degrees(std::array<double, 4> angles) {
  for (double& angle : angles) angle = nav::RadToDeg(angle);
  return angles;
}

std::array<double, 4> Radians(std::array<double, 4> angles) {
  for (double& angle : angles) angle = nav::DegToRad(angle);
  return angles;
}

nav::PolarizationCameraCalibration FromJson(const Json& json) {
  nav::PolarizationCameraCalibration c;
  c.width_px = json.at("width_px").get<int>();
  c.height_px = json.at("height_px").get<int>();
  c.bits = json.at("bits").get<int>();
  const std::string lens = json.at("lens").get<std::string>();
  if (lens != "pinhole" && lens != "equidistant") throw std::invalid_argument("no such lens");
  c.lens.model = lens == "equidistant" ? nav::LensModel::kEquidistant : nav::LensModel::kPinhole;
  c.lens.focal_px = json.at("focal_px").get<double>();
  c.lens.center_px = {json.at("center_px").at(0).get<double>(),
                      json.at("center_px").at(1).get<double>()};
  const auto q = json.at("q_BS_xyzw").get<std::array<double, 4>>();
  c.T_BS.q = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized();
  c.polarizer_rad = Radians(json.at("polarizer_deg").get<std::array<double, 4>>());
  c.gain = json.at("gain").get<std::array<double, 4>>();
  c.offset = json.at("offset").get<std::array<double, 4>>();
  c.full_well_e = json.at("full_well_e").get<double>();
  c.read_noise_e = json.at("read_noise_e").get<double>();
  c.gain_sigma = json.at("gain_sigma").get<double>();
  c.offset_sigma = json.at("offset_sigma").get<double>();
  c.polarizer_sigma_rad = nav::DegToRad(json.at("polarizer_sigma_deg").get<double>());
  c.mount_sigma_rad = nav::DegToRad(json.at("mount_sigma_deg").get<double>());
  c.center_sigma_px = json.at("center_sigma_px").get<double>();
  const bool usable = c.width_px > 0 && c.height_px > 0 && c.bits >= 8 && c.bits <= 16 &&
                      c.lens.focal_px > 0.0 && c.full_well_e > 0.0 &&
                      *std::min_element(c.gain.begin(), c.gain.end()) > 0.0;
  if (!usable) throw std::invalid_argument("a value is out of its range");
  return c;
}

Json ToJson(const nav::CameraCalibration& c) {
  const bool fisheye = c.model == nav::DistortionModel::kEquidistant;
  const Eigen::Vector3d& p = c.T_BC.p;
  return {{"model", fisheye ? "equidistant" : "radtan"},
          {"width_px", c.width_px},
          {"height_px", c.height_px},
          {"fx_px", c.fx_px},
          {"fy_px", c.fy_px},
          {"cx_px", c.cx_px},
          {"cy_px", c.cy_px},
          {"distortion", c.distortion},
          {"q_BC_xyzw", {c.T_BC.q.x(), c.T_BC.q.y(), c.T_BC.q.z(), c.T_BC.q.w()}},
          {"p_BC_m", {p.x(), p.y(), p.z()}}};
}

}  // namespace

Json ToJson(const nav::StereoCalibration& calibration) {
  return {{"left", ToJson(calibration.left)}, {"right", ToJson(calibration.right)}};
}

Json ToJson(const nav::PolarizationCameraCalibration& c) {
  const bool fisheye = c.lens.model == nav::LensModel::kEquidistant;
  return {{"width_px", c.width_px},
          {"height_px", c.height_px},
          {"bits", c.bits},
          {"lens", fisheye ? "equidistant" : "pinhole"},
          {"focal_px", c.lens.focal_px},
          {"center_px", {c.lens.center_px.x(), c.lens.center_px.y()}},
          {"q_BS_xyzw", {c.T_BS.q.x(), c.T_BS.q.y(), c.T_BS.q.z(), c.T_BS.q.w()}},
          {"polarizer_deg", Degrees(c.polarizer_rad)},
          {"gain", c.gain},
          {"offset", c.offset},
          {"full_well_e", c.full_well_e},
          {"read_noise_e", c.read_noise_e},
          {"gain_sigma", c.gain_sigma},
          {"offset_sigma", c.offset_sigma},
          {"polarizer_sigma_deg", nav::RadToDeg(c.polarizer_sigma_rad)},
          {"mount_sigma_deg", nav::RadToDeg(c.mount_sigma_rad)},
          {"center_sigma_px", c.center_sigma_px}};
}

nav::PolarizationCameraCalibration ReadCameraFile(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw InputError(file.string(), 0, "", "no such file");
  try {
    return FromJson(Json::parse(in));
  } catch (const std::exception& error) {
    throw InputError(file.string(), 0, "", std::string("no camera calibration: ") + error.what());
  }
}

void WriteCameraFile(const std::filesystem::path& file,
                     const nav::PolarizationCameraCalibration& calibration) {
  std::ofstream out(file);
  out << ToJson(calibration).dump(2) << "\n";
  if (!out) throw InputError(file.string(), 0, "", "cannot be written");
}

}  // namespace polnav::testbed
