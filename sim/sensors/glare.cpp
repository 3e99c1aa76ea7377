#include "sim/sensors/glare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "nav/api/geometry.h"
#include "sim/sensors/lens.h"
#include "sim/sensors/lens_warp.h"

namespace polnav::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kHalo = 40.0;
constexpr double kHaloAngle_rad = nav::DegToRad(1.5);
constexpr double kVeil = 0.6;
constexpr double kVeilAngle_rad = nav::DegToRad(35.0);
constexpr double kDimmestDisc = 20.0;  // radiance; the renderer's sun has 60 and an aureole
constexpr double kGhostField_rad = nav::DegToRad(60.0);

// Where on the line from the picture's centre (0) to the sun (1), how large, how bright.
struct Ghost {
  double place;
  double radius_share;  // of the picture's width
  double radiance;
};
constexpr std::array<Ghost, 5> kGhosts = {{{0.55, 0.012, 0.8},
                                           {0.30, 0.022, 0.4},
                                           {-0.28, 0.016, 0.7},
                                           {-0.55, 0.040, 0.3},
                                           {-1.00, 0.065, 0.2}}};

}  // namespace

Glare::Glare(const nav::CameraCalibration& camera)
    : camera_(camera),
      field_rad_(AngleOfField(camera)),
      rays_(camera.height_px, camera.width_px, CV_32FC3) {
  for (int row = 0; row < rays_.rows; ++row) {
    for (int col = 0; col < rays_.cols; ++col) {
      const Vector3d ray = RayOfPixel(camera, col, row).homogeneous().normalized();
      rays_.at<cv::Vec3f>(row, col) = {static_cast<float>(ray.x()), static_cast<float>(ray.y()),
                                       static_cast<float>(ray.z())};
    }
  }
}

// Beyond the field, where a distortion may fold back into the picture, further out in proportion to
// the angle. Far outside every picture when the sun is beside or behind the camera.
Vector2d Glare::PixelOfSun(const Vector3d& sun_C) const {
  const double psi = std::atan2(sun_C.head<2>().norm(), sun_C.z());
  if (psi > kGhostField_rad) return Vector2d::Constant(-1e6);
  if (psi <= field_rad_) return ProjectToPixel(camera_, sun_C);
  const Vector2d rim_xy = std::tan(field_rad_) * sun_C.head<2>().normalized();
  const Vector2d center(camera_.cx_px, camera_.cy_px);
  return center + psi / field_rad_ * (ProjectToPixel(camera_, rim_xy.homogeneous()) - center);
}

// Of the nine pixels about its centre; all of a sun that is beside the picture.
double Glare::SunInSight(const Vector3d& sun_C, double exposure, const cv::Mat& image) const {
  const Vector2d sun_px = PixelOfSun(sun_C);
  const double dimmest = std::min(250.0, 255.0 * exposure * kDimmestDisc);
  const cv::Rect around(static_cast<int>(std::lround(sun_px.x())) - 1,
                        static_cast<int>(std::lround(sun_px.y())) - 1, 3, 3);
  const cv::Rect seen = around & cv::Rect(0, 0, image.cols, image.rows);
  if (seen.area() < around.area()) return 1.0;
  return cv::countNonZero(image(seen) >= dimmest) / 9.0;
}

void Glare::Apply(double glare, const Vector3d& sun_C, double exposure, cv::Mat& image) const {
  const double psi = std::acos(std::clamp(sun_C.z(), -1.0, 1.0));
  // Less and less gets past the rim of the lens from 60 degrees on, nothing from behind.
  const double scale = 255.0 * exposure * glare * std::clamp(2.0 * sun_C.z(), 0.0, 1.0);
  const double veil = kVeil * std::exp(-std::pow(psi / kVeilAngle_rad, 2));
  const Eigen::Vector3f sun = sun_C.cast<float>();
  const auto narrow = static_cast<float>(1.0 / (kHaloAngle_rad * kHaloAngle_rad));
  cv::Mat added(image.size(), CV_32FC1);
  for (int row = 0; row < image.rows; ++row) {
    const auto* const ray = rays_.ptr<cv::Vec3f>(row);
    auto* const out = added.ptr<float>(row);
    for (int col = 0; col < image.cols; ++col) {
      // |ray - sun| is 2 sin(phi / 2), exact near the sun, where a cosine would round.
      const float dx = ray[col][0] - sun.x();
      const float dy = ray[col][1] - sun.y();
      const float dz = ray[col][2] - sun.z();
      const float chord2 = dx * dx + dy * dy + dz * dz;
      out[col] = static_cast<float>(scale) *
                 (static_cast<float>(veil) + static_cast<float>(kHalo) / (1.0F + narrow * chord2));
    }
  }
  if (psi < kGhostField_rad) AddGhosts(scale, PixelOfSun(sun_C), added);
  cv::add(image, added, image, cv::noArray(), CV_8U);
}

void Glare::AddGhosts(double scale, const Vector2d& sun_px, cv::Mat& added) const {
  const Vector2d center(camera_.cx_px, camera_.cy_px);
  for (const Ghost& ghost : kGhosts) {
    const Vector2d at = center + ghost.place * (sun_px - center);
    const double radius = ghost.radius_share * camera_.width_px;
    const double soft = 0.15 * radius;  // of the edge
    const cv::Rect box(
        static_cast<int>(at.x() - radius - soft), static_cast<int>(at.y() - radius - soft),
        static_cast<int>(2.0 * (radius + soft)) + 2, static_cast<int>(2.0 * (radius + soft)) + 2);
    const cv::Rect inside = box & cv::Rect(0, 0, added.cols, added.rows);
    for (int row = inside.y; row < inside.y + inside.height; ++row) {
      for (int col = inside.x; col < inside.x + inside.width; ++col) {
        const double from_edge = radius - (Vector2d(col, row) - at).norm();
        const double share = std::clamp(0.5 + 0.5 * from_edge / soft, 0.0, 1.0);
        added.at<float>(row, col) += static_cast<float>(scale * ghost.radiance * share);
      }
    }
  }
}

}  // namespace polnav::sim
