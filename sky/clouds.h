// How much thin cloud lies along this ray, and how does it turn the polarization?
//
// A frozen layer at one altitude, carried by the wind past the observer: gradient noise of four
// octaves (each half the size and half the amplitude) on an integer lattice with its own hash, so
// that the same seed is the same cloud everywhere. The layer is a spherical shell about the earth,
// which keeps the distance to it finite at the horizon.
// Where it fails: no thick cloud, no change of shape in time, no forward-scattering aureole, no
// growth of the cloud's share towards the horizon.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace polnav::sky {

// Smooth noise over the plane, of mean 0, standard deviation near 1 and correlation length near 1.
[[nodiscard]] double LatticeNoise(const Eigen::Vector2d& position, std::uint64_t seed);

struct CloudLayer {
  double cover = 0.0;  // median share of light from cloud, 0 to 1; the mean is within 12 % of it
  double scale_m = 400.0;                              // correlation length
  double altitude_m = 2e3;                             // above the observer
  Eigen::Vector2d wind_m_s = Eigen::Vector2d::Zero();  // east, north
  std::uint64_t seed = 0;
};

struct CloudLight {
  double share = 0.0;     // of the light that comes from cloud, [0, 1]
  double turn_rad = 0.0;  // of the cloud light's angle of polarization against the clear sky's
};

// ray_W: unit vector at or above the horizon, ENU.
[[nodiscard]] CloudLight LookAtClouds(const CloudLayer& layer, const Eigen::Vector3d& ray_W,
                                      const Eigen::Vector3d& observer_W, double t_s);

}  // namespace polnav::sky
