#include "sky/sun_arc.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace polnav::sky {
namespace {

constexpr double kMeanSolarDay_s = 86400.0;

}  // namespace

Eigen::Vector3d SunArc::At(double t_s) const {
  const double rate = turn_W_rad_s.norm();
  if (rate == 0.0) return start_W;
  return Eigen::AngleAxisd(rate * t_s, turn_W_rad_s / rate) * start_W;
}

SunArc ComputeSunArc(const Site& site, const UtcDate& utc) {
  const SunPosition sun = ComputeSun(site, utc);
  // The sky turns from east to west: against the earth, whose axis stands over north at the
  // latitude's height.
  const Eigen::Vector3d pole_W(0.0, std::cos(site.latitude_rad), std::sin(site.latitude_rad));
  return {.start_W = DirectionEnu(sun.azimuth_rad, sun.elevation_rad),
          .turn_W_rad_s = -2.0 * std::numbers::pi / kMeanSolarDay_s * pole_W};
}

}  // namespace polnav::sky
