// Where does the sun go during a run?
//
// One position from the ephemeris, carried on by the sky's turn about the celestial pole, one turn
// a mean solar day. What it leaves out is the sun's own way in declination (0.017 degrees an hour
// at most) and changing refraction: 0.005 degrees after 10 minutes, and for a sun that sets within
// two hours 0.02 after half an hour and 0.065 after an hour.
#pragma once

#include <Eigen/Core>

#include "sky/sun.h"

namespace polnav::sky {

struct SunArc {
  Eigen::Vector3d start_W = Eigen::Vector3d::UnitZ();  // unit vector towards the sun at time zero
  Eigen::Vector3d turn_W_rad_s = Eigen::Vector3d::Zero();

  // Unit vector towards the sun t_s seconds after time zero.
  [[nodiscard]] Eigen::Vector3d At(double t_s) const;
};

// Apparent, that is with refraction.
[[nodiscard]] SunArc ComputeSunArc(const Site& site, const UtcDate& utc);

}  // namespace polnav::sky
