// A street of points for estimator tests: exact geometry, chosen noise, no pictures.
#pragma once

#include <cmath>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "nav/api/measurements.h"
#include "nav/stereo/rectifier.h"

namespace polnav::nav {

// The camera of the tests: ZED-like, at the body's origin, looking along x.
inline StereoCalibration TestCalibration() {
  Eigen::Matrix3d R_BC;
  R_BC << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  CameraCalibration left{.width_px = 672,
                         .height_px = 376,
                         .fx_px = 350.0,
                         .fy_px = 350.0,
                         .cx_px = 335.5,
                         .cy_px = 187.5};
  left.T_BC = {Eigen::Quaterniond(R_BC), {0.2, 0.06, 1.0}};
  CameraCalibration right = left;
  right.T_BC.p.y() -= 0.12;
  return {left, right};
}

// Points on both sides of a circular road of this radius about `center`, and features as a car on
// it sees them. Every point keeps its id for as long as the street exists.
class SyntheticStreet {
 public:
  SyntheticStreet(const RectifiedCamera& camera, double radius_m, unsigned seed)
      : camera_(camera), random_(seed), center_(-radius_m, 0.0, 0.0), radius_m_(radius_m) {
    std::uniform_real_distribution<double> angle(0.0, 2.0 * M_PI);
    std::uniform_real_distribution<double> offset(-25.0, 25.0);
    std::uniform_real_distribution<double> height(-1.5, 8.0);
    while (points_.size() < 6000) {
      const double side = offset(random_);
      if (std::abs(side) < 3.0) continue;
      const double a = angle(random_);
      const double r = radius_m_ + side;
      points_.emplace_back(center_.x() + r * std::cos(a), center_.y() + r * std::sin(a),
                           height(random_));
    }
  }

  // On the road after driving s_m counter-clockwise from the origin, heading north there.
  [[nodiscard]] Pose PoseAt(double s_m) const {
    const double a = s_m / radius_m_;
    return {LevelAttitude(-a), center_ + radius_m_ * Eigen::Vector3d(std::cos(a), std::sin(a), 0)};
  }

  [[nodiscard]] StereoFeatures See(const Pose& T_WB, TimeNs stamp, double sigma_px) {
    std::normal_distribution<double> noise(0.0, sigma_px);
    const Pose T_CW = (T_WB * camera_.T_BC).Inverse();
    StereoFeatures seen{.stamp = stamp};
    for (std::size_t i = 0; i < points_.size() && seen.features.size() < 200; ++i) {
      const Eigen::Vector3d p_C = T_CW * points_[i];
      if (p_C.z() < 1.0 || p_C.z() > 40.0) continue;
      const double u = camera_.f_px * p_C.x() / p_C.z() + camera_.cx_px;
      const double v = camera_.f_px * p_C.y() / p_C.z() + camera_.cy_px;
      if (u < 0 || u > 671 || v < 0 || v > 375) continue;
      const double disparity = camera_.f_px * camera_.baseline_m / p_C.z();
      const double u_seen = u + noise(random_);
      seen.features.push_back({.id = i,
                               .uv_left_px = {u_seen, v + noise(random_)},
                               .u_right_px = u_seen - disparity - noise(random_)});
    }
    return seen;
  }

  // See, with a random descriptor that belongs to the point, whoever looks at it.
  [[nodiscard]] StereoFeatures SeeDescribed(const Pose& T_WB, TimeNs stamp, double sigma_px) {
    StereoFeatures seen = See(T_WB, stamp, sigma_px);
    seen.descriptors.create(static_cast<int>(seen.features.size()), 32, CV_8UC1);
    for (std::size_t i = 0; i < seen.features.size(); ++i) {
      cv::RNG random(seen.features[i].id + 1);
      cv::Mat row = seen.descriptors.row(static_cast<int>(i));
      random.fill(row, cv::RNG::UNIFORM, 0, 256);
    }
    return seen;
  }

 private:
  RectifiedCamera camera_;
  std::mt19937 random_;
  Eigen::Vector3d center_;
  double radius_m_;
  std::vector<Eigen::Vector3d> points_;
};

}  // namespace polnav::nav
