// About which axes are the Stokes parameters of a viewing ray?
//
// Axis 1 lies in the vertical plane of the ray and points away from the zenith; axis 2 is
// horizontal, towards increasing compass azimuth. Angles of polarization count from 1 towards 2.
// (axis 1, axis 2, ray) is left-handed: a camera behind the ray sees these angles run clockwise.
// At the zenith, where no azimuth is defined, the ray is taken to come down from north.
#pragma once

#include <Eigen/Core>

namespace polnav::sky {

struct RayAxes {
  Eigen::Vector3d axis1_W;
  Eigen::Vector3d axis2_W;
  Eigen::Vector3d ray_W;

  // A vector's components along axis 1, axis 2 and the ray: what the sky models take.
  [[nodiscard]] Eigen::Vector3d Components(const Eigen::Vector3d& vector_W) const {
    return {axis1_W.dot(vector_W), axis2_W.dot(vector_W), ray_W.dot(vector_W)};
  }
};

// ray_W: unit vector, ENU.
[[nodiscard]] inline RayAxes AxesOf(const Eigen::Vector3d& ray_W) {
  const double flat = ray_W.head<2>().norm();
  const Eigen::Vector2d along =
      flat > 1e-12 ? Eigen::Vector2d(ray_W.head<2>() / flat) : Eigen::Vector2d::UnitY();
  return {.axis1_W = {ray_W.z() * along.x(), ray_W.z() * along.y(), -flat},
          .axis2_W = {along.y(), -along.x(), 0.0},
          .ray_W = ray_W};
}

}  // namespace polnav::sky
