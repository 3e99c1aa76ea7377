#include "sim/sensors/lens.h"

#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "sim/sensors/lens_warp.h"
#include "sim/sensors/stereo_camera.h"

namespace polnav::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

nav::CameraCalibration Camera() {
  StereoCameraOptions options;
  options.p1 = 0.002;  // large enough to see a swapped order
  options.p2 = -0.003;
  return NominalStereo(options).left;
}

// 134 degrees from corner to corner.
nav::CameraCalibration FisheyeCamera() {
  StereoCameraOptions options;
  options.model = "equidistant";
  options.focal_px = 330.0;
  options.k1 = -0.02;
  options.k2 = 0.004;
  options.k3 = -0.003;
  options.k4 = 0.001;
  return NominalStereo(options).left;
}

TEST(Lens, ProjectsAsOpenCvsFisheyeDoes) {
  const nav::CameraCalibration camera = FisheyeCamera();
  const cv::Matx33d k(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  const cv::Vec4d d(camera.distortion.data());
  for (const Vector3d& p : {Vector3d(0.3, 0.4, 1.0), Vector3d(-2.2, 0.5, 1.1), Vector3d(0, 0, 2)}) {
    std::vector<cv::Point2d> pixel;
    cv::fisheye::projectPoints(std::vector<cv::Point3d>{{p.x(), p.y(), p.z()}}, pixel, cv::Vec3d(),
                               cv::Vec3d(), k, d);
    EXPECT_LT((ProjectToPixel(camera, p) - Vector2d(pixel[0].x, pixel[0].y)).norm(), 1e-9);
  }
}

TEST(Lens, ProjectsAsOpenCvDoes) {
  const nav::CameraCalibration camera = Camera();
  const cv::Matx33d k(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  const std::vector<double> d(camera.distortion.begin(), camera.distortion.end());
  for (const Vector3d& p : {Vector3d(0.3, 0.4, 1.0), Vector3d(-1.2, 0.5, 1.1)}) {
    std::vector<cv::Point2d> pixel;
    cv::projectPoints(std::vector<cv::Point3d>{{p.x(), p.y(), p.z()}}, cv::Vec3d(), cv::Vec3d(), k,
                      d, pixel);
    EXPECT_LT((ProjectToPixel(camera, p) - Vector2d(pixel[0].x, pixel[0].y)).norm(), 1e-9);
  }
}

TEST(Lens, UndistortsWhatItDistortedOverTheWholeImage) {
  for (const nav::CameraCalibration& camera : {Camera(), FisheyeCamera()}) {
    for (int u = 0; u < camera.width_px; u += 61) {
      for (int v = 0; v < camera.height_px; v += 25) {
        const Vector2d ray = RayOfPixel(camera, u, v);
        const Vector2d back = ProjectToPixel(camera, ray.homogeneous());
        EXPECT_LT((back - Vector2d(u, v)).norm(), 1e-9);
      }
    }
  }
}

TEST(Lens, KnowsHowFarFromTheAxisItsCornersLook) {
  nav::CameraCalibration camera = FisheyeCamera();
  camera.distortion = {};  // the ideal equidistant lens: radius = f angle
  EXPECT_NEAR(AngleOfField(camera), std::hypot(camera.cx_px, camera.cy_px) / camera.fx_px, 1e-12);
  EXPECT_LT(AngleOfField(FisheyeCamera()), kWidestAngle_rad);
  camera.distortion = {-0.4, 0.0, 0.0, 0.0};  // folds back at 0.91 rad
  EXPECT_TRUE(std::isnan(AngleOfField(camera)));
}

TEST(LensWarp, RefusesALensThatSeesTooWideForAPinhole) {
  nav::CameraCalibration camera = FisheyeCamera();
  camera.fx_px = camera.fy_px = 290.0;  // 76 degrees in the corners
  EXPECT_THROW(static_cast<void>(CoveringView({camera}, 0.75)), std::logic_error);
  camera.fx_px = camera.fy_px = 200.0;  // beyond 90: no pinhole has these pixels
  EXPECT_THROW(static_cast<void>(CoveringView({camera}, 0.75)), std::logic_error);
}

// A ramp along x and one along y carry the position in their grey value: eight pixels a grey level
// would hide an error, so the ramp repeats every 16 pixels and is looked at away from its wrap.
// Rounding to 1/32 pixel errs by at most 1/64; the grey value, 15 levels a pixel, by 0.5 / 15 more.
void ExpectWarpWithinATwentiethOfAPixel(const nav::CameraCalibration& camera) {
  const PinholeView view = CoveringView({camera}, 0.8);
  const LensWarp warp(camera, view);
  cv::Mat ramp(view.height_px, view.width_px, CV_8UC1);
  for (int v = 0; v < ramp.rows; ++v) {
    for (int u = 0; u < ramp.cols; ++u) {
      ramp.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(15 * (u % 16));
    }
  }
  cv::Mat warped;
  warp.Apply(ramp, warped);
  int compared = 0;
  for (int v = 0; v < warped.rows; v += 3) {
    for (int u = 0; u < warped.cols; ++u) {
      const double x = view.fx_px * RayOfPixel(camera, u, v).x() + view.cx_px;
      const double phase = std::fmod(x, 16.0);
      if (phase > 14.5 || phase < 0.5) continue;
      EXPECT_NEAR(warped.at<std::uint8_t>(v, u) / 15.0, phase, 1.0 / 64.0 + 0.5 / 15.0 + 1e-3);
      ++compared;
    }
  }
  EXPECT_GT(compared, 60000);
}

TEST(LensWarp, TakesEachPixelFromWithinATwentiethOfAPixel) {
  ExpectWarpWithinATwentiethOfAPixel(Camera());
  ExpectWarpWithinATwentiethOfAPixel(FisheyeCamera());
}

TEST(LensWarp, WarpsRowsAsItWarpsTheWholeImage) {
  const nav::CameraCalibration camera = Camera();
  const PinholeView view = CoveringView({camera}, 0.8);
  const LensWarp warp(camera, view);
  cv::Mat image(view.height_px, view.width_px, CV_8UC1);
  cv::randu(image, 0, 256);
  cv::Mat whole;
  warp.Apply(image, whole);
  cv::Mat strips(whole.size(), CV_8UC1, cv::Scalar(0));
  warp.ApplyToRows(image, {0, 100}, strips);
  EXPECT_EQ(cv::countNonZero(strips.rowRange(100, strips.rows)), 0);
  warp.ApplyToRows(image, {100, strips.rows}, strips);
  EXPECT_EQ(cv::norm(whole, strips, cv::NORM_INF), 0.0);
}

TEST(LensWarp, NeverLooksAtThePixelsDeclaredUnseen) {
  const nav::StereoCalibration stereo = DrawTrueStereo({}, 3, 4);
  const PinholeView view = CoveringView({stereo.left, stereo.right}, 0.8);
  const std::vector<Vector2d> triangles = UnseenTriangles({stereo.left, stereo.right}, view);
  double area = 0.0;
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const Vector2d ab = triangles[i + 1] - triangles[i];
    const Vector2d ac = triangles[i + 2] - triangles[i];
    area += 0.5 * std::abs(ab.x() * ac.y() - ab.y() * ac.x());
  }
  EXPECT_GT(area, 0.1 * view.width_px * view.height_px);  // worth the trouble
  for (const nav::CameraCalibration& camera : {stereo.left, stereo.right}) {
    for (int u = 0; u < camera.width_px; u += 7) {
      for (const int v : {0, camera.height_px - 1}) {
        const Vector2d xy = RayOfPixel(camera, u, v);
        const Vector2d p(view.fx_px * xy.x() + view.cx_px, view.fy_px * xy.y() + view.cy_px);
        for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
          std::vector<cv::Point2f> t;
          for (std::size_t k = i; k < i + 3; ++k) {
            t.emplace_back(static_cast<float>(triangles[k].x()),
                           static_cast<float>(triangles[k].y()));
          }
          const cv::Point2f at(static_cast<float>(p.x()), static_cast<float>(p.y()));
          // Bilinear interpolation reaches one pixel further.
          EXPECT_LT(cv::pointPolygonTest(t, at, true), -1.0);
        }
      }
    }
  }
}

}  // namespace
}  // namespace polnav::sim
