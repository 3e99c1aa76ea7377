#include "sim/render/lighting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "nav/api/geometry.h"

namespace polnav::sim {
namespace {

using std::numbers::pi;

// Light of the sun on a facet that faces it, over pi, relative to the zenith's radiance. Some 7 in
// clean air at an elevation of 16 degrees; a third of that through haze, which also keeps sunlit
// and shaded walls within the eight bits of a camera.
constexpr double kSunOverZenith = 3.0;
constexpr double kGroundReflectance = 0.2;
// The sun's own glow is counted with the sun; what a patch near it may add is bounded.
constexpr double kBrightestPatch = 6.0;

double Radiance(const sky::SkyInstant& sky, const Eigen::Vector3d& direction_W) {
  return sky.Look(direction_W, Eigen::Vector3d::Zero()).radiance;
}

// Forward scattering by haze around the sun, and the disc itself; both mostly saturate.
double Aureole(double angle_rad) {
  const double angle_deg = nav::RadToDeg(angle_rad);
  const double disc = angle_deg < 0.3 ? 60.0 : 0.0;
  return disc + 5.0 * std::exp(-angle_deg / 1.2) + 0.8 * std::exp(-angle_deg / 9.0);
}

}  // namespace

Lighting::Lighting(const sky::WorldSky& sky) : sun_W_(sky.sun_W()) {
  constexpr int kRings = 8;
  constexpr int kSectors = 16;
  const sky::SkyInstant at_start = sky.At(0.0);
  double on_the_level = 0.0;
  for (int ring = 0; ring < kRings; ++ring) {
    for (int sector = 0; sector < kSectors; ++sector) {
      // Equal steps of the height of the unit sphere are equal solid angles.
      const double z = (ring + 0.5) / kRings;
      const double azimuth = 2.0 * pi * (sector + 0.5 * (ring % 2)) / kSectors;
      const double r = std::sqrt(1.0 - z * z);
      const Eigen::Vector3d direction(r * std::cos(azimuth), r * std::sin(azimuth), z);
      const double radiance = std::min(Radiance(at_start, direction), kBrightestPatch);
      patches_.push_back({direction, radiance * 2.0 / (kRings * kSectors)});
      on_the_level += patches_.back().weight * z;
    }
  }
  sun_ = sun_W_.z() > 0.0 ? kSunOverZenith : 0.0;
  ground_ = kGroundReflectance * (on_the_level + sun_ * std::max(0.0, sun_W_.z()));
}

double Lighting::OfWhite(const Eigen::Vector3d& normal_W) const {
  double light = sun_ * std::max(0.0, normal_W.dot(sun_W_));
  for (const SkyPatch& patch : patches_) {
    light += patch.weight * std::max(0.0, normal_W.dot(patch.direction_W));
  }
  return light + ground_ * 0.5 * (1.0 - normal_W.z());
}

SkyDome BuildSkyDome(const sky::WorldSky& sky) {
  constexpr int kSectors = 24;
  constexpr std::array kRings_deg = {0.001, 0.25,  0.32,  0.9,   2.0,   4.0,   7.0,
                                     12.0,  18.0,  25.0,  33.0,  41.0,  49.0,  57.0,
                                     65.0,  73.0,  81.0,  89.0,  97.0,  105.0, 113.0,
                                     121.0, 130.0, 139.0, 148.0, 158.0, 168.0, 179.999};
  const Eigen::Quaterniond q_WN =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), sky.sun_W());
  const sky::SkyInstant at_start = sky.At(0.0);
  SkyDome dome;
  for (const double ring_deg : kRings_deg) {
    const double angle = nav::DegToRad(ring_deg);
    for (int sector = 0; sector < kSectors; ++sector) {
      const double around = 2.0 * pi * sector / kSectors;
      const Eigen::Vector3d direction =
          q_WN * Eigen::Vector3d(std::sin(angle) * std::cos(around),
                                 std::sin(angle) * std::sin(around), std::cos(angle));
      const double radiance = Radiance(at_start, direction) + Aureole(angle);
      dome.vertices.push_back({direction.cast<float>(), static_cast<float>(radiance)});
    }
  }
  for (std::uint32_t ring = 0; ring + 1 < kRings_deg.size(); ++ring) {
    for (std::uint32_t sector = 0; sector < kSectors; ++sector) {
      const std::uint32_t a = ring * kSectors + sector;
      const std::uint32_t b = ring * kSectors + (sector + 1) % kSectors;
      dome.indices.insert(dome.indices.end(), {a, b, a + kSectors, b, b + kSectors, a + kSectors});
    }
  }
  return dome;
}

}  // namespace polnav::sim
