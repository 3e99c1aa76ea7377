// What are Stokes parameters about other axes across the same ray?
#pragma once

#include <Eigen/Core>

#include "sky/skylight.h"

namespace polnav::sky {

// [I, Q, U] about the transverse unit vectors x and y: the E-vector is an axis, and its tensor
// q (a1 a1 - a2 a2) + u (a1 a2 + a2 a1) is read along them, whichever way the axes wind.
[[nodiscard]] inline Eigen::Vector3d StokesAbout(const Eigen::Vector3d& x_W,
                                                 const Eigen::Vector3d& y_W,
                                                 const Skylight& light) {
  const double x1 = x_W.dot(light.axis1_W);
  const double x2 = x_W.dot(light.axis2_W);
  const double y1 = y_W.dot(light.axis1_W);
  const double y2 = y_W.dot(light.axis2_W);
  return light.radiance *
         Eigen::Vector3d(1.0, light.q * (x1 * x1 - x2 * x2) + 2.0 * light.u * x1 * x2,
                         light.q * (x1 * y1 - x2 * y2) + light.u * (x1 * y2 + x2 * y1));
}

}  // namespace polnav::sky
