#include "sim/render/sky_dome.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "nav/api/geometry.h"

namespace polnav::sim {
namespace {

using std::numbers::pi;

constexpr std::uint32_t kSectors = 72;
// From the sun; a step of 4.5 degrees resolves a cumulus of 600 m at 1500 m down to 20 degrees.
constexpr std::array kNear_deg = {0.001, 0.25, 0.32, 0.9, 2.0, 4.0, 7.0, 11.0};
constexpr double kStep_deg = 4.5;
constexpr std::uint32_t kPatchSectors = 12;
constexpr std::uint32_t kPatchRings = 8;

// Forward scattering by haze around the sun, and the disc itself; both mostly saturate.
double Aureole(double angle_rad) {
  const double angle_deg = nav::RadToDeg(angle_rad);
  const double disc = angle_deg < 0.3 ? 60.0 : 0.0;
  return disc + 5.0 * std::exp(-angle_deg / 1.2) + 0.8 * std::exp(-angle_deg / 9.0);
}

std::vector<double> Rings_deg() {
  std::vector<double> rings(kNear_deg.begin(), kNear_deg.end());
  while (rings.back() + kStep_deg < 179.0) rings.push_back(rings.back() + kStep_deg);
  rings.push_back(179.999);
  return rings;
}

// The triangles between rings from first_ring to last_ring, over kPatchSectors sectors.
void AddPatch(std::uint32_t first_ring, std::uint32_t last_ring, std::uint32_t first_sector,
              SkyDome& dome) {
  const std::size_t first = dome.indices.size();
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (std::uint32_t ring = first_ring; ring < last_ring; ++ring) {
    for (std::uint32_t i = 0; i < kPatchSectors; ++i) {
      const std::uint32_t a = ring * kSectors + first_sector + i;
      const std::uint32_t b = ring * kSectors + (first_sector + i + 1) % kSectors;
      dome.indices.insert(dome.indices.end(), {a, b, a + kSectors, b, b + kSectors, a + kSectors});
    }
  }
  for (std::size_t i = first; i < dome.indices.size(); ++i) {
    sum += dome.vertices[dome.indices[i]].direction_W;
  }
  const Eigen::Vector3f center = sum.normalized();
  float least_cos = 1.0F;
  for (std::size_t i = first; i < dome.indices.size(); ++i) {
    least_cos = std::min(least_cos, center.dot(dome.vertices[dome.indices[i]].direction_W));
  }
  dome.patches.push_back({first, dome.indices.size() - first, center.cast<double>(),
                          std::acos(std::clamp(static_cast<double>(least_cos), -1.0, 1.0))});
}

}  // namespace

SkyDome BuildSkyDome(const sky::WorldSky& sky) {
  const Eigen::Quaterniond q_WN =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), sky.sun_W());
  const std::vector<double> rings_deg = Rings_deg();
  SkyDome dome;
  for (const double ring_deg : rings_deg) {
    const double angle = nav::DegToRad(ring_deg);
    for (std::uint32_t sector = 0; sector < kSectors; ++sector) {
      const double around = 2.0 * pi * sector / kSectors;
      const Eigen::Vector3d direction =
          q_WN * Eigen::Vector3d(std::sin(angle) * std::cos(around),
                                 std::sin(angle) * std::sin(around), std::cos(angle));
      dome.vertices.push_back({direction.cast<float>(), 0.0F});
    }
  }
  const auto rings = static_cast<std::uint32_t>(rings_deg.size());
  for (std::uint32_t ring = 0; ring + 1 < rings; ring += kPatchRings) {
    for (std::uint32_t sector = 0; sector < kSectors; sector += kPatchSectors) {
      AddPatch(ring, std::min(ring + kPatchRings, rings - 1), sector, dome);
    }
  }
  UpdateRadiance(sky, 0.0, dome);
  return dome;
}

void UpdateRadiance(const sky::WorldSky& sky, double t_s, SkyDome& dome) {
  const sky::SkyInstant now = sky.At(t_s);
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  const Eigen::Vector3d sun_W = sky.sun_W();  // drawn where it stood at the start
  for (SkyDome::Vertex& v : dome.vertices) {
    const Eigen::Vector3d direction = v.direction_W.cast<double>().normalized();
    const double angle = std::acos(std::clamp(direction.dot(sun_W), -1.0, 1.0));
    const double glow = Aureole(angle) * now.Transmittance(direction, origin);
    v.radiance = static_cast<float>(now.Look(direction, origin).radiance + glow);
  }
}

}  // namespace polnav::sim
