#include "sky/polarimeter.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sky/stokes_axes.h"

namespace polnav::sky {

namespace {

using std::numbers::pi;

// Gauss-Legendre on [0, 1], three nodes.
constexpr std::array<double, 3> kNodes = {0.11270166537925831, 0.5, 0.88729833462074169};
constexpr std::array<double, 3> kWeights = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
constexpr int kAzimuths = 12;

// Stokes parameters [I, Q, U] of one ray, about the axes of S carried to the ray.
Eigen::Vector3d LookFrom(const Eigen::Quaterniond& q_WS, const Eigen::Vector3d& ray_S,
                         const Eigen::Vector3d& observer_W, const SkyInstant& sky,
                         const Cover& cover, const FogAbove& fog) {
  const Eigen::Quaterniond q_SP =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), ray_S);
  const Eigen::Quaterniond q_WP = q_WS * q_SP;
  const Eigen::Vector3d ray_W = (q_WP * Eigen::Vector3d::UnitZ()).normalized();
  if (const auto hidden_by = cover ? cover(ray_W) : std::nullopt) return {*hidden_by, 0.0, 0.0};
  const Skylight light = sky.Look(ray_W, observer_W);
  const Eigen::Vector3d stokes =
      StokesAbout(q_WP * Eigen::Vector3d::UnitX(), q_WP * Eigen::Vector3d::UnitY(), light);
  return fog.Through(stokes, ray_W.z());
}

}  // namespace

double FogAbove::Passed(double up) const {
  return depth == 0.0 ? 1.0 : std::exp(-depth / std::max(up, 0.01));
}

Eigen::Vector3d FogAbove::Through(const Eigen::Vector3d& stokes, double up) const {
  if (depth == 0.0) return stokes;
  const double passed = Passed(up);
  return passed * stokes + (1.0 - passed) * radiance * Eigen::Vector3d::UnitX();
}

ConeLight AverageOverCone(double fov_rad, const Eigen::Quaterniond& q_WS,
                          const Eigen::Vector3d& observer_W, double t_s, const WorldSky& sky,
                          const Cover& cover, const FogAbove& fog) {
  if (!(fov_rad >= 0.0 && fov_rad <= pi)) {
    throw std::logic_error("AverageOverCone: the cone is not between 0 and pi wide");
  }
  const double depth = 1.0 - std::cos(0.5 * fov_rad);  // of the cap on the unit sphere
  const SkyInstant now = sky.At(t_s);
  Eigen::Vector3d stokes = Eigen::Vector3d::Zero();
  for (std::size_t ring = 0; ring < kNodes.size(); ++ring) {
    const double cosine = 1.0 - depth * kNodes[ring];  // equal steps of it are equal solid angles
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    for (int k = 0; k < kAzimuths; ++k) {
      const double azimuth = 2.0 * pi * k / kAzimuths;
      const Eigen::Vector3d ray_S(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine);
      stokes += kWeights[ring] / kAzimuths * LookFrom(q_WS, ray_S, observer_W, now, cover, fog);
    }
  }
  if (stokes[0] <= 0.0) return {};  // black all over
  return {stokes[0], stokes[1] / stokes[0], stokes[2] / stokes[0]};
}

SixChannels ReadSixChannels(const SixChannelOptics& optics, const Eigen::Quaterniond& q_WS,
                            const Eigen::Vector3d& observer_W, double t_s, const WorldSky& sky,
                            const Cover& cover, const FogAbove& fog) {
  const ConeLight light = AverageOverCone(optics.fov_rad, q_WS, observer_W, t_s, sky, cover, fog);
  SixChannels reading{};
  for (std::size_t i = 0; i < reading.size(); ++i) {
    const double alpha = kPolarizerAngles_rad[i] + optics.angle_error_rad[i];
    const double passed = 1.0 + light.q * std::cos(2.0 * alpha) + light.u * std::sin(2.0 * alpha);
    reading[i] = optics.gain[i] * optics.exposure * light.i * passed + optics.offset[i];
  }
  return reading;
}

SixChannels Digitize(const SixChannels& reading, const SixChannels& normals, double relative_sigma,
                     int bits) {
  if (bits < 1 || bits > 32) {
    throw std::logic_error("Digitize: no converter of so many bits");
  }
  const double top = std::ldexp(1.0, bits) - 1.0;
  SixChannels out{};
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double noisy = reading[i] * (1.0 + relative_sigma * normals[i]);
    out[i] = std::round(std::clamp(noisy, 0.0, 1.0) * top) / top;
  }
  return out;
}

}  // namespace polnav::sky
