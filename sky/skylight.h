// What light comes from this direction of the simulated sky?
//
// The sky that the world has: it is never the one that an estimator assumes (rayleigh.h). Only the
// simulator uses this file. One sky for cameras (radiance) and polarimeters alike, continuous in
// direction, place and time:
//   Stokes = T (clear + air) + (1 - T) cloud
//   clear  clear_sky.h: rayleigh, berry (neutral points) or hazy, for where the sun is then
//   cloud  clouds.h: T, the cloud's own light, and light between clouds in the air before them
// At the defaults (thin_cloud), readings at the zenith err by 0.5 degrees RMS for the veil,
// correlated over scale / wind = 50 s.
// Where it fails: as those two do; no light from the ground beyond what hazy was fitted to; the
// sun's disc and aureole are the cameras' own business; after sunset it is only finite.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sky/clear_sky.h"
#include "sky/clouds.h"
#include "sky/sun_arc.h"

namespace polnav::sky {

// YAML keys = field names; those of the clear sky stand beside the clouds'.
struct SkyOptions {
  ClearSkyOptions clear;

  // A preset; each number that is given stands in the preset's place.
  std::string clouds = "thin_cloud";
  std::optional<double> cloud_cover;          // share of the sky under thick cloud
  std::optional<double> cloud_optical_depth;  // of thick cloud, mean; 3 hides the sky behind it
  std::optional<double> cloud_scale_m;        // correlation length of the layer
  std::optional<double> cloud_altitude_m;     // above the observer
  std::optional<double> thin_cloud_cover;     // median share of the zenith's light from a veil
  double wind_m_s = 8.0;                      // the layer moves downwind
  double wind_to_deg = 70.0;                  // compass azimuth that it moves to

  template <typename Visitor>
  void Visit(Visitor& v) {
    clear.Visit(v);
    v("clouds", clouds, {"clear", "thin_cloud", "few_clouds", "many_clouds", "overcast"});
    v("cloud_cover", cloud_cover, {.min = 0.0, .max = 1.0});
    v("cloud_optical_depth", cloud_optical_depth, {.min = 0.0, .max = 200.0});
    v("cloud_scale_m", cloud_scale_m, {.min = 10.0, .max = 1e5});
    v("cloud_altitude_m", cloud_altitude_m, {.min = 100.0, .max = 2e4});
    v("thin_cloud_cover", thin_cloud_cover, {.min = 0.0, .max = 0.9});
    v("wind_m_s", wind_m_s, {.min = 0.0, .max = 100.0});
    v("wind_to_deg", wind_to_deg, {.min = -360.0, .max = 360.0});
  }
};

// The preset with the numbers that stand in its place.
[[nodiscard]] CloudWeather WeatherOf(const SkyOptions& options);

// Light from one direction, or from the horizon below it. Stokes parameters are about axis 1: in
// the vertical plane of the viewing ray, pointing away from the zenith; axis 2: towards increasing
// compass azimuth (ray_axes.h).
struct Skylight {
  double radiance = 0.0;  // relative to the clear zenith
  double q = 0.0;         // Q / I
  double u = 0.0;         // U / I
  Eigen::Vector3d axis1_W = Eigen::Vector3d::UnitX();
  Eigen::Vector3d axis2_W = Eigen::Vector3d::UnitY();
};

// The sky at one instant: what to hold while looking along many rays. Its WorldSky must outlive it.
class SkyInstant {
 public:
  SkyInstant(const ClearSky& clear, const CloudLayer& clouds, double t_s)
      : clear_(clear), clouds_(&clouds), t_s_(t_s) {}

  // ray_W: unit vector towards the sky, ENU; below the horizon it is answered as at the horizon.
  // observer_W: where the eye is [m].
  [[nodiscard]] Skylight Look(const Eigen::Vector3d& ray_W,
                              const Eigen::Vector3d& observer_W) const;

  // What the clouds let through of a light behind them, such as the sun's disc; 1 without any.
  [[nodiscard]] double Transmittance(const Eigen::Vector3d& ray_W,
                                     const Eigen::Vector3d& observer_W) const;

  [[nodiscard]] const ClearSky& clear() const { return clear_; }

 private:
  ClearSky clear_;
  const CloudLayer* clouds_;
  double t_s_;
};

class WorldSky {
 public:
  // sun: where it goes, ENU. seed: of the cloud field.
  WorldSky(const SkyOptions& options, const SunArc& sun, std::uint64_t seed,
           const std::vector<CloudPassage>& passages = {});
  // A sun that stands still. sun_W: unit vector towards it.
  WorldSky(const SkyOptions& options, const Eigen::Vector3d& sun_W, std::uint64_t seed)
      : WorldSky(options, SunArc{.start_W = sun_W}, seed) {}

  // t_s: seconds since the scenario's start.
  [[nodiscard]] SkyInstant At(double t_s) const {
    return {ClearSky(clear_, sun_W(t_s)), clouds_, t_s};
  }

  // One ray by itself, as SkyInstant::Look; preparing the instant costs as much as some rays.
  [[nodiscard]] Skylight Look(const Eigen::Vector3d& ray_W, const Eigen::Vector3d& observer_W,
                              double t_s) const {
    return At(t_s).Look(ray_W, observer_W);
  }

  // As SkyInstant's.
  [[nodiscard]] double Transmittance(const Eigen::Vector3d& ray_W,
                                     const Eigen::Vector3d& observer_W, double t_s) const;

  [[nodiscard]] Eigen::Vector3d sun_W(double t_s = 0.0) const { return sun_.At(t_s); }

 private:
  SunArc sun_;
  ClearSkyOptions clear_;
  CloudLayer clouds_;
};

}  // namespace polnav::sky
