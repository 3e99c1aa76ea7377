// How do small rotations and their errors enter a sensor model?
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "sim/random.h"

namespace polnav::sim {

// Exp: the rotation by |v| radians about v.
[[nodiscard]] inline Eigen::Quaterniond RotationOf(const Eigen::Vector3d& v) {
  const double angle = v.norm();
  if (angle == 0.0) {
    return Eigen::Quaterniond::Identity();
  }
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, v / angle));
}

// Log: its inverse, of the shorter way round, |v| <= pi.
[[nodiscard]] inline Eigen::Vector3d RotationVector(const Eigen::Quaterniond& q) {
  const double sine = q.vec().norm();
  if (sine == 0.0) {
    return Eigen::Vector3d::Zero();
  }
  const double half = q.w() < 0.0 ? std::atan2(-sine, -q.w()) : std::atan2(sine, q.w());
  return 2.0 * half / sine * q.vec();
}

// Three draws of mean 0 and sigma 1, in the order x, y, z.
[[nodiscard]] inline Eigen::Vector3d GaussianVector(RandomStream::Sample& draw) {
  Eigen::Vector3d v;
  for (int axis = 0; axis < 3; ++axis) {
    v[axis] = draw.Gaussian();
  }
  return v;
}

}  // namespace polnav::sim
