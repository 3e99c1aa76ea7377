#include "nav/stereo/rectifier.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace polnav::nav {
namespace {

// A pair behind two fisheye lenses, the right one turned by a third of a degree.
StereoCalibration Fisheyes() {
  CameraCalibration left{.model = DistortionModel::kEquidistant,
                         .width_px = 672,
                         .height_px = 376,
                         .fx_px = 330.0,
                         .fy_px = 331.0,
                         .cx_px = 335.0,
                         .cy_px = 188.0,
                         .distortion = {-0.02, 0.004, -0.003, 0.001}};
  Eigen::Matrix3d R_BC;
  R_BC << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  left.T_BC = {Eigen::Quaterniond(R_BC), {0.2, 0.06, 1.2}};
  CameraCalibration right = left;
  right.T_BC.p = left.T_BC * Eigen::Vector3d(0.12, 0.0, 0.0);
  right.T_BC.q =
      right.T_BC.q * Eigen::AngleAxisd(0.006, Eigen::Vector3d(1.0, -2.0, 0.5).normalized());
  return {left, right};
}

// [Kannala2006, eq. 6] written out.
std::vector<cv::Point2f> Pixel(const CameraCalibration& c, const Eigen::Vector3d& p_B) {
  const Eigen::Vector3d p = c.T_BC.Inverse() * p_B;
  const double theta = std::atan2(p.head<2>().norm(), p.z());
  double radius = theta;
  for (int i = 0; i < 4; ++i) radius += c.distortion[i] * std::pow(theta, 2 * i + 3);
  const Eigen::Vector2d xy = radius * p.head<2>().normalized();
  return {{static_cast<float>(c.fx_px * xy.x() + c.cx_px),
           static_cast<float>(c.fy_px * xy.y() + c.cy_px)}};
}

// Single-precision pixels carry 3e-5 px, and at 60 degrees from the axis a pixel of the fisheye is
// four of the virtual pinhole.
TEST(StereoRectifier, MakesAPinholePairOfTwoFisheyes) {
  const StereoCalibration fisheyes = Fisheyes();
  const StereoRectifier rectifier(fisheyes);
  const RectifiedCamera& camera = rectifier.camera();
  for (const Eigen::Vector3d& p_B :
       {Eigen::Vector3d(9.0, -4.0, 3.5), Eigen::Vector3d(4.0, 6.5, 0.3),
        Eigen::Vector3d(30.0, 1.0, 2.0)}) {
    const cv::Point2f left = rectifier.RectifyLeft(Pixel(fisheyes.left, p_B)).front();
    const cv::Point2f right = rectifier.RectifyRight(Pixel(fisheyes.right, p_B)).front();
    const Eigen::Vector3d p_C = camera.T_BC.Inverse() * p_B;
    EXPECT_NEAR(left.y, right.y, 1e-3);
    EXPECT_NEAR(left.x - right.x, camera.f_px * camera.baseline_m / p_C.z(), 1e-3);
    EXPECT_NEAR(left.x, camera.f_px * p_C.x() / p_C.z() + camera.cx_px, 1e-3);
    EXPECT_NEAR(left.y, camera.f_px * p_C.y() / p_C.z() + camera.cy_px, 1e-3);
  }
}

// There and back again: what single precision and the inverse distortion leave.
TEST(StereoRectifier, RawRightUndoesRectifyRight) {
  StereoCalibration radtan = Fisheyes();
  for (CameraCalibration* c : {&radtan.left, &radtan.right}) {
    c->model = DistortionModel::kRadTan;
    c->distortion = {-0.17, 0.025, 3e-4, -2e-4};
  }
  for (const StereoCalibration& calibration : {Fisheyes(), radtan}) {
    const StereoRectifier rectifier(calibration);
    for (const cv::Point2f raw :
         {cv::Point2f(335.0F, 188.0F), cv::Point2f(60.5F, 40.25F), cv::Point2f(600.0F, 340.0F)}) {
      const cv::Point2f back = rectifier.RawRight(rectifier.RectifyRight({raw}).front());
      EXPECT_NEAR(back.x, raw.x, 2e-3);
      EXPECT_NEAR(back.y, raw.y, 2e-3);
    }
  }
}

}  // namespace
}  // namespace polnav::nav
