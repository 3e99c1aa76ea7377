#include "sky/clear_sky.h"

#include <cmath>
#include <stdexcept>

namespace polnav::sky {

namespace {

ClearSky::Model MakeModel(const ClearSkyOptions& options, double sun_elevation_rad) {
  if (options.model == "rayleigh") return RayleighSky{options.max_dop};
  if (options.model == "berry") {
    const double half = BerryHalfSeparation(sun_elevation_rad, options.aot);
    return BerrySky(options.max_dop, options.separation_scale * half, sun_elevation_rad);
  }
  if (options.model == "hazy") {
    return HazySky(options.aot, options.wavelength_nm, sun_elevation_rad);
  }
  throw std::invalid_argument("sky model '" + options.model +
                              "': known are rayleigh, berry and hazy");
}

double ElevationOf(const Eigen::Vector3d& sun_W) {
  if (std::abs(sun_W.squaredNorm() - 1.0) > 1e-6) {
    throw std::logic_error("ClearSky: the sun's direction is no unit vector");
  }
  return std::atan2(sun_W.z(), sun_W.head<2>().norm());
}

}  // namespace

ClearSky::ClearSky(const ClearSkyOptions& options, const Eigen::Vector3d& sun_W)
    : sun_W_(sun_W), model_(MakeModel(options, ElevationOf(sun_W))) {}

}  // namespace polnav::sky
