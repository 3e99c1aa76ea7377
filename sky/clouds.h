// How much cloud lies along this ray, and what does it do to the skylight?
//
// One frozen layer at one altitude, a spherical shell about the earth, carried by the wind past the
// observer. Its vertical optical depth follows one smooth field n (lattice_noise.h) of the place:
//   tau = veil exp(0.45 n) + thick max(0, n - t)
// a thin veil everywhere and clouds where n exceeds the t that gives the cover asked for; either
// may be absent. Along a ray that meets the layer at cos from its normal, T = exp(-tau / cos) of
// the clear sky comes through, and the rest is the cloud's own light:
//   radiance      diffuse transmittance 1 / (1 + (1 - g) tau / 2) [Bohren1987], and sunlight that
//                 thin edges scatter forward [Henyey1941]: the silver lining
//   polarization  that of the clear sky behind it, of which thin cloud keeps 0.40 and thick cloud
//                 0.13, turned by a random angle; in one cloud patch of twenty turned by 90 degrees
// Air between clouds is lit by them as well as by the sun: it is brighter and less polarized.
//
// The presets stand on published statistics, stated before any compass was run on them:
//   preset       cover [WMO306]         depth [Rossow1999]
//   few_clouds   "few", 1 to 2 oktas    cumulus, below 3.6
//   many_clouds  "broken", 5 to 7       stratocumulus, 3.6 to 23
//   overcast     8 oktas                stratus, above 23
//   polarization: overcast degree at most 0.16 [Hegedus2007]; 40 to 70 % of a clear sky within 5
//   degrees of Rayleigh's angle, less under cloud [Suhai2004]; angle mostly kept beneath clouds
//   [Pomozi2001]; few clouds turned by 90 degrees [Pust2008].
// The sources give no numbers for the rest (brightness, what cloud keeps, spread of the turn, share
// of turned patches, light between clouds, sizes): those are choices. docs/clouds.md has the table
// of published against measured values.
// Where it fails: a flat layer (no sides, no towers, no growth of the cover towards the horizon,
// one altitude), no change of shape in time, no shadows on the ground or on the air below, no halo,
// no ice; sampled at points, so that it aliases in the lowest five degrees.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstdint>
#include <string>
#include <vector>

#include "sky/lattice_noise.h"

namespace polnav::sky {

// What a preset names.
struct CloudWeather {
  double cover = 0.0;          // share of the sky under thick cloud, 0 to 1
  double optical_depth = 0.0;  // of thick cloud, vertical: the mean where there is some
  double veil = 0.0;           // median share of the zenith's light that thin cloud gives, below 1
  double scale_m = 400.0;      // correlation length of the layer
  double altitude_m = 2e3;     // above the observer
};

// clear, thin_cloud, few_clouds, many_clouds or overcast; throws std::invalid_argument otherwise.
[[nodiscard]] CloudWeather WeatherOf(const std::string& preset);

// A cloud that the wind carries over a place at an instant. It is a kilometre across the wind, or
// round where its way over the place is longer. Its edge is ragged as the layer's field is.
struct CloudPassage {
  Eigen::Vector2d over_m = Eigen::Vector2d::Zero();  // the place: east, north
  double middle_s = 0.0;                             // when it stands overhead
  double duration_s = 20.0;                          // from edge to edge
  double optical_depth = 10.0;                       // vertical, inside
};

// What a layer does along one ray. The default is no cloud.
struct CloudColumn {
  double transmittance = 1.0;  // of light that meets no droplet on its way down the ray
  double optical_depth = 0.0;  // vertical
  // Polarization (Q + i U) / I of the cloud's own light over that of the clear sky behind it.
  std::complex<double> kept = 0.0;
  double air_light = 0.0;  // added by the clouds to the air's radiance, over the clear sky's
  Eigen::Vector2d air_lit_from = Eigen::Vector2d::Zero();  // east, north; at most 1 long
};

class CloudLayer {
 public:
  // wind_m_s: east, north; not zero when there are passages. seed: of the field.
  CloudLayer(const CloudWeather& weather, const Eigen::Vector2d& wind_m_s, std::uint64_t seed,
             const std::vector<CloudPassage>& passages = {});

  // Neither veil nor cloud anywhere.
  [[nodiscard]] bool empty() const {
    return veil_depth_ == 0.0 && thick_depth_ == 0.0 && passing_.empty();
  }

  // ray_W: unit vector at or above the horizon, ENU.
  [[nodiscard]] CloudColumn Look(const Eigen::Vector3d& ray_W, const Eigen::Vector3d& observer_W,
                                 double t_s) const;

 private:
  // An ellipse in the layer, carried along with it.
  struct Passing {
    Eigen::Vector2d center_m;  // east, north; overhead of the origin at time zero would be (0, 0)
    Eigen::Vector2d radius_m;  // along and across the wind
    double depth;
  };

  double altitude_m_;
  double scale_m_;
  Eigen::Vector2d wind_m_s_;
  double veil_depth_ = 0.0;   // optical depth at the field's median
  double thick_depth_ = 0.0;  // optical depth per unit of the field above its threshold
  double threshold_ = 0.0;    // of the field, where thick cloud begins
  LatticeNoise field_;
  std::vector<Passing> passing_;
};

// Radiance of a cloud's own light, relative to the clear zenith, were the cloud opaque.
// cos_sun: cosine of the ray's angle from the sun. up: sine of the ray's elevation.
[[nodiscard]] double CloudRadiance(double optical_depth, double cos_sun, double up);

// Polarization of the light that the clouds add to the air, (Q + i U) / I: towards is air_lit_from
// by its components along the ray's two axes.
[[nodiscard]] std::complex<double> AirPolarization(std::complex<double> towards);

}  // namespace polnav::sky
