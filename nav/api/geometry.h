// How are poses and headings written down?
//
//   W  world, ENU, z up        B  body, x forward, y left, z up (REP-103)
//   C  rectified left camera, x right, y down, z forward
// T_WB maps B coordinates into W; adjacent letters cancel: T_WC = T_WB * T_BC.
// A heading is a compass azimuth: clockwise from north, radians inside, of the body's x axis.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace polnav::nav {

// T_AB: q_AB rotates B coordinates into A, p_AB is B's origin in A [m].
struct Pose {
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();

  [[nodiscard]] Pose Inverse() const {
    const Eigen::Quaterniond q_inv = q.conjugate();
    return {q_inv, -(q_inv * p)};
  }
  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return q * point + p;
  }
  [[nodiscard]] Pose operator*(const Pose& other) const {
    return {(q * other.q).normalized(), q * other.p + p};
  }
};

// [rad] into [-pi, pi].
[[nodiscard]] inline double WrapPi(double angle) {
  return std::remainder(angle, 2.0 * std::numbers::pi);
}

// [rad] into [-pi/2, pi/2]: differences of axes, which repeat every half turn.
[[nodiscard]] inline double WrapHalfPi(double angle) {
  return std::remainder(angle, std::numbers::pi);
}

// Compass heading of the body's x axis [rad], in (-pi, pi]. Undefined when x points at the zenith.
[[nodiscard]] inline double CompassHeading(const Eigen::Quaterniond& q_WB) {
  const Eigen::Vector3d x_W = q_WB * Eigen::Vector3d::UnitX();
  return std::atan2(x_W.x(), x_W.y());
}

// Level attitude q_WB whose x axis has this compass heading [rad].
[[nodiscard]] inline Eigen::Quaterniond LevelAttitude(double heading) {
  return Eigen::Quaterniond(
      Eigen::AngleAxisd(0.5 * std::numbers::pi - heading, Eigen::Vector3d::UnitZ()));
}

[[nodiscard]] constexpr double DegToRad(double deg) { return deg * std::numbers::pi / 180.0; }
[[nodiscard]] constexpr double RadToDeg(double rad) { return rad * 180.0 / std::numbers::pi; }

}  // namespace polnav::nav
