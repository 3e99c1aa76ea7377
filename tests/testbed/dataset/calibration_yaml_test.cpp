// What the estimators are told survives sensor.yaml to the last bit; what no sensor can be is
// refused by key.
#include "tools/testbed/dataset/calibration_yaml.h"

#include <gtest/gtest.h>

#include "tests/testbed/dataset/dataset_files.h"
#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

// The rig of the small scenario, with numbers that no short decimal has.
nav::Rig OddRig() {
  nav::Rig rig = sim::NominalRig(SmallScenario().sensors);
  const Eigen::Quaterniond turn = Eigen::Quaterniond(1.0, 0.1, -0.03, 0.007).normalized();
  const auto move = [&](nav::Pose& T_BS) {
    T_BS = {(turn * T_BS.q).normalized(), T_BS.p + Eigen::Vector3d(1.0 / 3.0, -1e-7 / 3.0, 0.0)};
  };
  move(rig.stereo->left.T_BC);
  move(rig.stereo->right.T_BC);
  move(rig.imu->T_BI);
  move(rig.polarimeter->T_BS);
  move(rig.polarization_camera->T_BS);
  rig.stereo->left.fx_px = 100.0 / 3.0;
  rig.stereo->right.model = nav::DistortionModel::kEquidistant;
  rig.stereo->right.distortion = {0.1 / 3.0, -0.2 / 3.0, 1e-5 / 3.0, 0.0};
  rig.imu->gyro_bias_instability_rad_s = 1e-5 / 3.0;
  rig.polarization_camera->gain = {1.0 / 3.0, 1.0, 1.1, 2.0 / 3.0};
  rig.polarization_camera->focal_sigma = 1e-3 / 3.0;
  nav::InstrumentCovariance covariance = nav::InstrumentCovariance::Identity() / 3.0;
  covariance(0, 5) = 1e-3 / 7.0;
  covariance(5, 0) = covariance(0, 5);
  rig.polarization_camera->covariance = covariance;
  return rig;
}

SensorSection SectionOf(const nav::Rig& rig, const std::string& folder) {
  for (const SensorYaml& file : SensorYamls(rig, SmallScenario().sensors)) {
    if (file.folder == folder) return {ParseYaml(ToYaml(file.yaml), folder), ""};
  }
  throw std::logic_error("no such sensor");
}

void ExpectSame(const nav::Pose& a, const nav::Pose& b) {
  EXPECT_EQ(a.q.coeffs(), b.q.coeffs());
  EXPECT_EQ(a.p, b.p);
}

void ExpectSame(const nav::CameraCalibration& a, const nav::CameraCalibration& b) {
  ExpectSame(a.T_BC, b.T_BC);
  EXPECT_EQ(a.model, b.model);
  EXPECT_EQ(a.distortion, b.distortion);
  EXPECT_EQ(std::make_tuple(a.width_px, a.height_px, a.fx_px, a.fy_px, a.cx_px, a.cy_px),
            std::make_tuple(b.width_px, b.height_px, b.fx_px, b.fy_px, b.cx_px, b.cy_px));
}

TEST(CalibrationYaml, CamerasComeBackToTheLastBit) {
  const nav::Rig rig = OddRig();
  ExpectSame(CameraFrom(SectionOf(rig, "cam0")), rig.stereo->left);
  ExpectSame(CameraFrom(SectionOf(rig, "cam1")), rig.stereo->right);
}

TEST(CalibrationYaml, TheImuComesBackToTheLastBit) {
  const nav::ImuCalibration told = *OddRig().imu;
  const nav::ImuCalibration read = ImuFrom(SectionOf(OddRig(), "imu0"));
  ExpectSame(read.T_BI, told.T_BI);
  EXPECT_EQ(read.rate_hz, told.rate_hz);
  EXPECT_EQ(read.gyro_noise_rad_s_sqrt_hz, told.gyro_noise_rad_s_sqrt_hz);
  EXPECT_EQ(read.accel_noise_m_s2_sqrt_hz, told.accel_noise_m_s2_sqrt_hz);
  EXPECT_EQ(read.gyro_bias_sigma_rad_s, told.gyro_bias_sigma_rad_s);
  EXPECT_EQ(read.accel_bias_sigma_m_s2, told.accel_bias_sigma_m_s2);
  EXPECT_EQ(read.gyro_bias_instability_rad_s, told.gyro_bias_instability_rad_s);
  EXPECT_EQ(read.accel_bias_instability_m_s2, told.accel_bias_instability_m_s2);
  EXPECT_EQ(read.gyro_bias_walk_rad_s_sqrt_s, told.gyro_bias_walk_rad_s_sqrt_s);
  EXPECT_EQ(read.accel_bias_walk_m_s2_sqrt_s, told.accel_bias_walk_m_s2_sqrt_s);
}

TEST(CalibrationYaml, PolarimetersComeBackToTheLastBit) {
  const nav::Rig rig = OddRig();
  const nav::PolarimeterCalibration point = PolarimeterFrom(SectionOf(rig, "pol0"));
  ExpectSame(point.T_BS, rig.polarimeter->T_BS);
  EXPECT_EQ(point.fov_rad, rig.polarimeter->fov_rad);
  const nav::PolarizationCameraCalibration told = *rig.polarization_camera;
  const nav::PolarizationCameraCalibration read = PolarizationCameraFrom(SectionOf(rig, "polcam0"));
  ExpectSame(read.T_BS, told.T_BS);
  EXPECT_EQ(read.lens.model, told.lens.model);
  EXPECT_EQ(read.lens.focal_px, told.lens.focal_px);
  EXPECT_EQ(read.lens.center_px, told.lens.center_px);
  EXPECT_EQ(read.polarizer_rad, told.polarizer_rad);
  EXPECT_EQ(read.gain, told.gain);
  EXPECT_EQ(read.offset, told.offset);
  EXPECT_EQ(*read.covariance, *told.covariance);
  EXPECT_EQ(std::make_tuple(read.width_px, read.height_px, read.bits, read.full_well_e,
                            read.read_noise_e, read.gain_sigma, read.offset_sigma),
            std::make_tuple(told.width_px, told.height_px, told.bits, told.full_well_e,
                            told.read_noise_e, told.gain_sigma, told.offset_sigma));
  EXPECT_EQ(std::make_tuple(read.polarizer_sigma_rad, read.mount_sigma_rad, read.focal_sigma,
                            read.center_sigma_px),
            std::make_tuple(told.polarizer_sigma_rad, told.mount_sigma_rad, told.focal_sigma,
                            told.center_sigma_px));
}

// As EuRoC and Kalibr write it: a matrix alone, comments, keys that we do not know.
std::string OthersCamera() {
  return "# General sensor definitions.\n"
         "sensor_type: camera\n"
         "comment: VI-Sensor cam0\n"
         "T_BS:\n"
         "  cols: 4\n"
         "  rows: 4\n"
         "  data: [0.0, 0.0, 1.0, 0.1,\n"
         "        -1.0, 0.0, 0.0, 0.0,\n"
         "         0.0, -1.0, 0.0, 0.0,\n"
         "         0.0, 0.0, 0.0, 1.0]\n"
         "rate_hz: 20\n"
         "resolution: [752, 480]\n"
         "camera_model: pinhole\n"
         "intrinsics: [458.654, 457.296, 367.215, 248.375] #fu, fv, cu, cv\n"
         "distortion_model: radial-tangential\n"
         "distortion_coefficients: [-0.28, 0.07, 0.0002, 1.76e-05]\n"
         "timeshift_cam_imu: 0.01\n";
}

std::string ErrorOf(const std::string& what, const std::string& with) {
  std::string text = OthersCamera();
  text.replace(text.find(what), what.size(), with);
  try {
    (void)CameraFrom({ParseYaml(text, "sensor.yaml"), ""});
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(CalibrationYaml, OthersFilesAreRead) {
  const nav::CameraCalibration c = CameraFrom({ParseYaml(OthersCamera(), "sensor.yaml"), ""});
  EXPECT_EQ(c.width_px, 752);
  EXPECT_EQ(c.fy_px, 457.296);
  EXPECT_EQ(c.model, nav::DistortionModel::kRadTan);
  EXPECT_LT((c.T_BC.q * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_EQ(ErrorOf("radial-tangential", "equidistant"), "no error");
  EXPECT_EQ(ErrorOf("1.76e-05]", "1.76e-05, 0.0]"), "no error");  // k3 = 0
}

TEST(CalibrationYaml, WhatNoCameraCanBeIsRefusedByLineAndKey) {
  EXPECT_EQ(ErrorOf("458.654", "0.0"),
            "sensor.yaml:14: intrinsics: focal lengths are positive, got 0 and 457.296");
  EXPECT_EQ(ErrorOf("-1.0, 0.0, 0.0, 0.0", "-2.0, 0.0, 0.0, 0.0"),
            "sensor.yaml:7: T_BS.data: its upper left 3 x 3 is no rotation");
  EXPECT_EQ(ErrorOf("0.0, 0.0, 1.0, 0.1", "0.0, 0.0, -1.0, 0.1"),  // a mirror
            "sensor.yaml:7: T_BS.data: its upper left 3 x 3 is no rotation");
  EXPECT_EQ(ErrorOf("resolution: [752, 480]\n", ""),
            "sensor.yaml: resolution: missing; expected a list of numbers");
  EXPECT_EQ(ErrorOf("[752, 480]", "[752, 0]"),
            "sensor.yaml:12: resolution: 0 is no number of pixels from 16 to 16384");
  EXPECT_EQ(ErrorOf("camera_model: pinhole", "camera_model: omni"),
            "sensor.yaml:13: camera_model: 'omni' is not one of: pinhole");
  EXPECT_EQ(ErrorOf("1.76e-05]", "1.76e-05, 0.1]"),
            "sensor.yaml:16: distortion_coefficients: more than 4 coefficients are not supported");
  EXPECT_EQ(ErrorOf("367.215", "nan"), "sensor.yaml:14: intrinsics: item 2 is no number");
  EXPECT_EQ(ErrorOf("rows: 4", "rows: 3"), "sensor.yaml:6: T_BS.rows: 3 is out of range, [4, 4]");
  EXPECT_EQ(ErrorOf("rate_hz: 20", "q_BS_xyzw: [0, 0, 0, 1]"),
            "sensor.yaml:11: q_BS_xyzw: disagrees with T_BS; change both, or leave this one out");
}

TEST(CalibrationYaml, APairNeedsABaselineToTheRight) {
  nav::StereoCalibration stereo = *sim::NominalRig(SmallScenario().sensors).stereo;
  const SensorSection right = SectionOf(OddRig(), "cam1");
  EXPECT_NO_THROW(CheckPair(stereo, right));
  EXPECT_THROW(CheckPair({stereo.right, stereo.left}, right), InputError);
  EXPECT_THROW(CheckPair({stereo.left, stereo.left}, right), InputError);
  stereo.right.width_px += 2;
  EXPECT_THROW(CheckPair(stereo, right), InputError);
}

}  // namespace
}  // namespace polnav::testbed
