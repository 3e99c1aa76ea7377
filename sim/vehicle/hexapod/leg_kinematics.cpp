#include "sim/vehicle/hexapod/leg_kinematics.h"

#include <cmath>
#include <numbers>

namespace polnav::sim {
namespace {

// Front legs point forward by half a right angle, rear legs backward, middle legs sideways.
constexpr std::array<double, kLegs> kRootAzimuth_deg = {45.0, 90.0, 135.0, -135.0, -90.0, -45.0};

bool InRange(const LegOptions& leg, const Eigen::Vector3d& angles_rad) {
  const Eigen::Vector3d middle(0.0, 0.0, -0.5 * std::numbers::pi);
  return (angles_rad - middle).cwiseAbs().maxCoeff() <= nav::DegToRad(leg.joint_range_deg);
}

}  // namespace

std::array<nav::Pose, kLegs> LegRoots(const HexapodOptions& options) {
  std::array<nav::Pose, kLegs> roots;
  const double half_length = 0.5 * options.body_size_m.x();
  const double half_width = 0.5 * options.body_size_m.y();
  for (int i = 0; i < kLegs; ++i) {
    const double azimuth = nav::DegToRad(kRootAzimuth_deg[i]);
    const bool middle = i == 1 || i == 4;
    const double x = middle ? 0.0 : std::copysign(half_length, std::cos(azimuth));
    // The middle of the body is its widest part.
    const double y = std::copysign(middle ? half_width : 0.75 * half_width, azimuth);
    roots[i] = {Eigen::Quaterniond(Eigen::AngleAxisd(azimuth, Eigen::Vector3d::UnitZ())),
                {x, y, 0.0}};
  }
  return roots;
}

Eigen::Vector3d FootOf(const LegOptions& leg, const Eigen::Vector3d& angles_rad) {
  const double knee = angles_rad.y() + angles_rad.z();
  const double out =
      leg.coxa_m + leg.femur_m * std::cos(angles_rad.y()) + leg.tibia_m * std::cos(knee);
  const double up = leg.femur_m * std::sin(angles_rad.y()) + leg.tibia_m * std::sin(knee);
  return {out * std::cos(angles_rad.x()), out * std::sin(angles_rad.x()), up};
}

std::optional<Eigen::Vector3d> AnglesFor(const LegOptions& leg, const Eigen::Vector3d& foot_H_m) {
  const double out = foot_H_m.head<2>().norm() - leg.coxa_m;
  const double far2 = out * out + foot_H_m.z() * foot_H_m.z();
  const double far = std::sqrt(far2);
  const double a = leg.femur_m;
  const double b = leg.tibia_m;
  if (far > a + b || far < std::abs(a - b) || far == 0.0) return std::nullopt;
  const double at_knee = std::acos((a * a + b * b - far2) / (2.0 * a * b));
  const double at_hip = std::acos((a * a + far2 - b * b) / (2.0 * a * far));
  const Eigen::Vector3d angles(std::atan2(foot_H_m.y(), foot_H_m.x()),
                               std::atan2(foot_H_m.z(), out) + at_hip, at_knee - std::numbers::pi);
  if (!InRange(leg, angles)) return std::nullopt;
  return angles;
}

}  // namespace polnav::sim
