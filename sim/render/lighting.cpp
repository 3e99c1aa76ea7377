#include "sim/render/lighting.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

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

double Lighting::FromSky(const Eigen::Vector3d& normal_W) const {
  double light = 0.0;
  for (const SkyPatch& patch : patches_) {
    light += patch.weight * std::max(0.0, normal_W.dot(patch.direction_W));
  }
  return light + ground_ * 0.5 * (1.0 - normal_W.z());
}

double Lighting::FromSun(const Eigen::Vector3d& normal_W) const {
  return sun_ * std::max(0.0, normal_W.dot(sun_W_));
}

double Lighting::OfWhite(const Eigen::Vector3d& normal_W) const {
  return FromSky(normal_W) + FromSun(normal_W);
}

std::array<float, 9> Lighting::SkyHarmonics() const {
  constexpr int kNormals = 200;  // on a spiral, evenly over the sphere
  Eigen::Matrix<double, kNormals, 9> basis;
  Eigen::Matrix<double, kNormals, 1> light;
  for (int i = 0; i < kNormals; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / kNormals;
    const double around = pi * (1.0 + std::sqrt(5.0)) * i;
    const double r = std::sqrt(1.0 - z * z);
    const Eigen::Vector3d n(r * std::cos(around), r * std::sin(around), z);
    basis.row(i) << 1.0, n.x(), n.y(), n.z(), n.x() * n.y(), n.y() * n.z(), n.x() * n.z(),
        n.x() * n.x() - n.y() * n.y(), 3.0 * n.z() * n.z() - 1.0;
    light[i] = FromSky(n);
  }
  const Eigen::Matrix<double, 9, 1> fit = basis.colPivHouseholderQr().solve(light);
  std::array<float, 9> coefficients{};
  for (std::size_t k = 0; k < 9; ++k) {
    coefficients[k] = static_cast<float>(fit[static_cast<Eigen::Index>(k)]);
  }
  return coefficients;
}

}  // namespace polnav::sim
