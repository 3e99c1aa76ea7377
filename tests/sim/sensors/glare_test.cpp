#include "sim/sensors/glare.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "sim/sensors/lens.h"
#include "sim/sensors/stereo_camera.h"
#include "tests/sim/render/marker_scene.h"

namespace polnav::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

cv::Mat Grey(int grey) { return {376, 672, CV_8UC1, cv::Scalar(grey)}; }

// The sky alone, the camera pitched up so that the sun stands in the picture.
nav::Pose LookingAtTheSun(double up_deg, double left_deg) {
  const Vector3d sun_W = TestSky().sun_W();
  const double heading = std::atan2(sun_W.x(), sun_W.y()) + nav::DegToRad(left_deg);
  const double elevation = std::asin(sun_W.z()) - nav::DegToRad(up_deg);
  return {nav::LevelAttitude(heading) * Eigen::AngleAxisd(-elevation, Vector3d::UnitY()),
          Vector3d::Zero()};
}

struct GlareCase {
  nav::CameraCalibration camera = NominalStereo(StereoCameraOptions{.pitch_down_deg = 0.0}).left;
  Vector3d SunInCamera(const nav::Pose& T_WB) const {
    return (T_WB.q * camera.T_BC.q).conjugate() * TestSky().sun_W();
  }
};

TEST(Glare, FallsWithTheSquareOfTheAngleAndSaturatesAroundTheSun) {
  const GlareCase c;
  const Vector3d sun_C = c.SunInCamera(LookingAtTheSun(12.0, 8.0));
  const Vector2d sun_px = ProjectToPixel(c.camera, sun_C);
  cv::Mat image = Grey(40);
  Glare(c.camera).Apply(1.0, sun_C, 0.3, image);
  const auto at = [&](double u, double v) {
    return image.at<std::uint8_t>(static_cast<int>(v), static_cast<int>(u)) - 40.0;
  };
  EXPECT_EQ(at(sun_px.x(), sun_px.y()), 215.0);
  // 10 and 20 degrees to the right of the sun: the veil taken off, a quarter is left.
  const double psi_deg = nav::RadToDeg(std::acos(sun_C.z()));
  const double veil = 255.0 * 0.3 * 0.6 * std::exp(-std::pow(psi_deg / 35.0, 2));
  double near = 0.0;
  double far = 0.0;
  int near_count = 0;
  int far_count = 0;
  for (int v = 0; v < 376; ++v) {
    for (int u = 0; u < 672; ++u) {
      const Vector3d ray = RayOfPixel(c.camera, u, v).homogeneous().normalized();
      const double phi = 2.0 * std::asin(0.5 * (ray - sun_C).norm());
      if (std::abs(nav::RadToDeg(phi) - 10.0) < 0.2) near += at(u, v), ++near_count;
      if (std::abs(nav::RadToDeg(phi) - 20.0) < 0.2) far += at(u, v), ++far_count;
    }
  }
  // Ghosts lie on some of either circle.
  EXPECT_NEAR((near / near_count - veil) / (far / far_count - veil), 4.0, 0.8);
}

TEST(Glare, IsLessTheFurtherTheSunIsBesideThePicture) {
  const GlareCase c;
  double last = 255.0;
  for (const double left_deg : {20.0, 55.0, 70.0, 100.0}) {
    cv::Mat image = Grey(40);
    Glare(c.camera).Apply(1.0, c.SunInCamera(LookingAtTheSun(12.0, left_deg)), 0.3, image);
    const double added = cv::mean(image)[0] - 40.0;
    EXPECT_LT(added, last);
    last = added;
  }
  EXPECT_LT(last, 1.0);
}

// A distortion that folds back beyond the corners must not put the sun into the picture, where it
// would be missed: 55 degrees from the axis, in the corner's direction, where r (1 - 0.3 r^2) has
// come back to less than it is in the corner.
TEST(Glare, TakesASunBeyondTheFieldForOneBesideThePicture) {
  GlareCase c;
  c.camera.distortion = {-0.3, 0.0, 0.0, 0.0};
  c.camera.fx_px = c.camera.fy_px = 600.0;
  const double psi = nav::DegToRad(55.0);
  const Vector3d sun_C(std::sin(psi) * 0.87, -std::sin(psi) * 0.49, std::cos(psi));
  const Vector2d folded = ProjectToPixel(c.camera, sun_C);
  ASSERT_TRUE(cv::Rect2d(2, 2, 668, 372).contains(cv::Point2d(folded.x(), folded.y())));
  EXPECT_EQ(Glare(c.camera).SunInSight(sun_C.normalized(), 0.3, Grey(40)), 1.0);
}

TEST(Glare, ThrowsGhostsOntoTheLineThroughTheCentre) {
  const GlareCase c;
  const Vector3d sun_C = c.SunInCamera(LookingAtTheSun(12.0, 20.0));
  const Vector2d center(c.camera.cx_px, c.camera.cy_px);
  cv::Mat image = Grey(40);
  Glare(c.camera).Apply(1.0, sun_C, 0.3, image);
  const Vector2d ghost = center - 0.28 * (ProjectToPixel(c.camera, sun_C) - center);
  const auto grey = [&](const Vector2d& p) {
    return image.at<std::uint8_t>(static_cast<int>(p.y()), static_cast<int>(p.x()));
  };
  EXPECT_GT(grey(ghost), grey(ghost + Vector2d(0.0, 20.0)) + 20);
  EXPECT_GT(grey(ghost), grey(ghost - Vector2d(0.0, 20.0)) + 20);
}

// Through the whole camera: the sky, and the same with a black wall before the sun.
TEST(Glare, ComesFromASunThatIsInSight) {
  const nav::Pose T_WB = LookingAtTheSun(12.0, 8.0);
  StereoCameraOptions options;
  options.full_well_e = 1e6;
  options.read_noise_e = 0.0;
  options.pitch_down_deg = 0.0;
  options.exposure = 0.05;  // most of this sky is below full scale
  const nav::StereoCalibration truth = NominalStereo(options);
  const auto added = [&](const Scene& scene) {
    StereoCamera camera(scene, TestSky(), truth, options, 1, 1);
    const cv::Mat clear = camera.Capture(T_WB, 0, 0).left;
    const cv::Mat glare = camera.Capture({.T_WB = T_WB, .conditions = {.glare = 1.0}}).left;
    return cv::mean(glare)[0] - cv::mean(clear)[0];
  };
  // The veil alone, 14 degrees from the axis.
  EXPECT_GT(added({}), 255.0 * 0.05 * 0.6 * std::exp(-std::pow(14.4 / 35.0, 2)));
  EXPECT_EQ(added(BlackRoom()), 0.0);
}

}  // namespace
}  // namespace polnav::sim
