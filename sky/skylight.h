// What light comes from this direction of the simulated sky?
//
// The sky that the world has: it is never the one that an estimator assumes (rayleigh.h).
// Only the simulator uses this file. One sky for cameras (radiance) and polarimeters alike,
// continuous in direction, place and time:
//   polarization  two neutral points above and below the sun, two opposite [Berry2004]
//   radiance      CIE standard general sky, type 12: clear, low turbidity
//   thin cloud    clouds.h; takes polarization away and turns it. At the defaults, readings at the
//                 zenith err by 0.5 degrees RMS for it, correlated over scale / wind = 50 s
// Where it fails: no wavelength, no growth of haze towards the horizon, no light from the ground,
// no thick cloud, no aureole; after sunset it is only finite.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "sky/clouds.h"
#include "sky/sun_arc.h"

namespace polnav::sky {

// YAML keys = field names.
struct SkyOptions {
  std::string model = "berry";  // rayleigh has no neutral points; berry splits them off the sun
  double max_dop = 0.70;        // degree of polarization 90 degrees from the sun; haze lowers it
  double neutral_point_separation_deg = 26.0;  // between Babinet and Brewster (berry)
  double thin_cloud_cover = 0.15;              // median share of light from cloud; 0 is a clear sky
  double thin_cloud_scale_m = 400.0;           // correlation length of the cloud layer
  double thin_cloud_altitude_m = 2000.0;
  double wind_m_s = 8.0;      // the layer moves downwind
  double wind_to_deg = 70.0;  // compass azimuth that it moves to

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("model", model, {"rayleigh", "berry"});
    v("max_dop", max_dop, {.min = 0.0, .max = 1.0});
    v("neutral_point_separation_deg", neutral_point_separation_deg, {.min = 0.0, .max = 80.0});
    v("thin_cloud_cover", thin_cloud_cover, {.min = 0.0, .max = 1.0});
    v("thin_cloud_scale_m", thin_cloud_scale_m, {.min = 10.0, .max = 1e5});
    v("thin_cloud_altitude_m", thin_cloud_altitude_m, {.min = 100.0, .max = 2e4});
    v("wind_m_s", wind_m_s, {.min = 0.0, .max = 100.0});
    v("wind_to_deg", wind_to_deg, {.min = -360.0, .max = 360.0});
  }
};

// Light from one direction, or from the horizon below it. Stokes parameters are about axis 1: in
// the vertical plane of the viewing ray, pointing away from the zenith; axis 2: towards increasing
// compass azimuth.
struct Skylight {
  double radiance = 0.0;  // relative to the clear zenith
  double q = 0.0;         // Q / I
  double u = 0.0;         // U / I
  Eigen::Vector3d axis1_W = Eigen::Vector3d::UnitX();
  Eigen::Vector3d axis2_W = Eigen::Vector3d::UnitY();
};

class WorldSky {
 public:
  // sun: where it goes, ENU. seed: of the cloud field.
  WorldSky(const SkyOptions& options, const SunArc& sun, std::uint64_t seed);
  // A sun that stands still. sun_W: unit vector towards it.
  WorldSky(const SkyOptions& options, const Eigen::Vector3d& sun_W, std::uint64_t seed)
      : WorldSky(options, SunArc{.start_W = sun_W}, seed) {}

  // ray_W: unit vector towards the sky, ENU; below the horizon it is answered as at the horizon.
  // observer_W: where the eye is [m]; t_s: seconds since the scenario's start.
  [[nodiscard]] Skylight Look(const Eigen::Vector3d& ray_W, const Eigen::Vector3d& observer_W,
                              double t_s) const;

  [[nodiscard]] Eigen::Vector3d sun_W(double t_s = 0.0) const { return sun_.At(t_s); }

 private:
  SunArc sun_;
  double max_dop_;
  double half_split_rad_ = 0.0;  // of the neutral points off the sun
  CloudLayer clouds_;
};

}  // namespace polnav::sky
