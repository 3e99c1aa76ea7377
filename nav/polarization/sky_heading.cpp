#include "nav/polarization/sky_heading.h"

#include <cmath>

namespace polnav::nav {

std::optional<double> HeadingFromEVector(const Eigen::Vector3d& e_B, const Eigen::Quaterniond& q_WB,
                                         const Eigen::Vector3d& sun_W) {
  // Turning the attitude by gamma about the vertical turns e_W with it:
  //   s . Rz(gamma) e = a cos(gamma) + b sin(gamma) + s_z e_z = 0.
  const Eigen::Vector3d e_W = q_WB * e_B;
  const double a = sun_W.x() * e_W.x() + sun_W.y() * e_W.y();
  const double b = sun_W.y() * e_W.x() - sun_W.x() * e_W.y();
  const double amplitude = std::hypot(a, b);
  const double cosine = -sun_W.z() * e_W.z() / amplitude;
  if (!(std::abs(cosine) <= 1.0)) return std::nullopt;
  const double middle = std::atan2(b, a);
  const double half = std::acos(cosine);
  const double first = WrapPi(middle + half);
  const double second = WrapPi(middle - half);
  const double gamma = std::abs(first) < std::abs(second) ? first : second;
  return WrapPi(CompassHeading(q_WB) - gamma);  // a turn about +z lowers the compass heading
}

Eigen::Vector2d HeadingByTilt(const Eigen::Vector3d& e_W, const Eigen::Vector3d& sun_W) {
  // s . Exp(dtheta) e_W = s . e_W + dtheta . (e_W x s): a tilt is made up for by a turn about z.
  const Eigen::Vector3d by_turn = e_W.cross(sun_W);
  return by_turn.head<2>() / by_turn.z();
}

double RayleighDop(const Eigen::Vector3d& look_W, const Eigen::Vector3d& sun_W, double max_dop) {
  const double cosine = look_W.dot(sun_W);
  return max_dop * (1.0 - cosine * cosine) / (1.0 + cosine * cosine);
}

}  // namespace polnav::nav
