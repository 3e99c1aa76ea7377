// What do the six channels of a point polarimeter read?
//
// Six photodiodes behind polarizers look at the same patch of sky [Zeng2020, eqs 2-3].
//   S   instrument: z along the line of sight, polarizer angles counted from x towards y
//   readings are shares of full scale, 0 to 1
// Every ray is weighted equally over the cone. Its axes are S's, turned by the smallest rotation
// that takes z to the ray: a real linear polarizer off its normal departs from that by half the
// squared angle from z (0.2 degrees at the rim of a 10 degree cone, cancelling over the cone).
// Not in it: stray light, dirt, spectral response, saturation before the quantizer.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <numbers>
#include <optional>

#include "sky/skylight.h"

namespace polnav::sky {

using SixChannels = std::array<double, 6>;

// Three opponent pairs, each a right angle apart [Zeng2020, eq. 3].
inline constexpr SixChannels kPolarizerAngles_rad = {
    0.0,
    std::numbers::pi / 2.0,
    std::numbers::pi / 3.0,
    std::numbers::pi * 5.0 / 6.0,
    std::numbers::pi * 2.0 / 3.0,
    std::numbers::pi * 7.0 / 6.0,
};

// One particular instrument, as it is.
struct SixChannelOptics {
  double fov_rad = 0.17453292519943295;  // full cone; 0 is a single ray
  double exposure = 0.3;  // K: reading of a channel under unpolarized light of radiance 1 [-]
  SixChannels gain = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
  SixChannels offset{};           // dark reading [-]
  SixChannels angle_error_rad{};  // polarizer's true angle minus the nominal one
};

// Radiance of what hides the sky along a ray (unit vector in W), or nothing where the sky is open.
// Hidden rays bring unpolarized light. An empty function: the sky is open everywhere.
using Cover = std::function<std::optional<double>(const Eigen::Vector3d& ray_W)>;

// A fog between the observer and the sky: unpolarized light of its own, and what it lets through.
struct FogAbove {
  double depth = 0.0;     // optical, straight up
  double radiance = 0.0;  // inside

  [[nodiscard]] double Passed(double up) const;  // share; up: sine of the ray's elevation
  // Stokes parameters [I, Q, U] of a ray from the sky, after it.
  [[nodiscard]] Eigen::Vector3d Through(const Eigen::Vector3d& stokes, double up) const;
};

// Light over the cone, about S's x axis.
struct ConeLight {
  double i = 0.0;  // mean radiance
  double q = 0.0;  // Q / I
  double u = 0.0;  // U / I
};

// 36 rays: three Gauss nodes in the cosine by twelve azimuths, exact for whatever varies over the
// cone like a polynomial of degree 5. Error of q and u, against 10800 rays, of a 10 (40) degree
// cone at the zenith: 1e-10 (3e-8) under a clear sky, 3e-5 (7e-4) RMS under the default thin cloud,
// that is 0.001 (0.02) degrees of angle.
[[nodiscard]] ConeLight AverageOverCone(double fov_rad, const Eigen::Quaterniond& q_WS,
                                        const Eigen::Vector3d& observer_W, double t_s,
                                        const WorldSky& sky, const Cover& cover = {},
                                        const FogAbove& fog = {});

// Noise-free readings, not yet limited to full scale:
// I_i = gain K I (1 + d cos(2 phi - 2 alpha_i)) + offset [Zeng2020, eq. 2].
[[nodiscard]] SixChannels ReadSixChannels(const SixChannelOptics& optics,
                                          const Eigen::Quaterniond& q_WS,
                                          const Eigen::Vector3d& observer_W, double t_s,
                                          const WorldSky& sky, const Cover& cover = {},
                                          const FogAbove& fog = {});

// Electronics: noise proportional to the reading, then an analogue-to-digital converter of so many
// bits whose full scale is 1. normals: of mean 0 and sigma 1; relative_sigma: noise over reading.
[[nodiscard]] SixChannels Digitize(const SixChannels& reading, const SixChannels& normals,
                                   double relative_sigma, int bits);

}  // namespace polnav::sky
