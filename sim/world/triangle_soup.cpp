#include "sim/world/triangle_soup.h"

#include <cmath>
#include <opencv2/core.hpp>

#include "sim/random.h"

namespace polnav::sim {
namespace {

using Eigen::Vector3d;

// Means over the textures of each kind.
double Reflectance(const Scene& scene, const Mesh& mesh) {
  switch (mesh.label) {
    case Label::kUser:
      return cv::mean(scene.textures.at(static_cast<std::size_t>(mesh.texture)))[0] / 255.0;
    case Label::kVegetation:
      return 0.15;
    case Label::kGround:
      return 0.25;
    default:
      return 0.4;
  }
}

// Leaves are where they are: a spot of foliage hides or does not, whoever looks.
bool HasLeafAt(const Vector3d& p_m, float cover) {
  constexpr double kSpot_m = 0.15;
  const auto cell = [](double x) {
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(x / kSpot_m)));
  };
  const std::uint32_t bits =
      Philox({cell(p_m.x()), cell(p_m.y()), cell(p_m.z()), 0}, {0x1eafU, 0})[0];
  return static_cast<float>(bits) * 0x1p-32F < cover;
}

}  // namespace

void TriangleSoup::Add(const Scene& scene, const Mesh& mesh) {
  const auto first = static_cast<int>(points.size() / 3);
  for (const Vertex& v : mesh.vertices) {
    const Vector3d p = v.p_W_m.cast<double>();
    points.insert(points.end(), {p.x(), p.y(), p.z()});
    box.extend(p);
  }
  const auto white = static_cast<float>(Reflectance(scene, mesh) * mesh.albedo);
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    float shade = 0.0F;
    for (std::size_t k = 0; k < 3; ++k) {
      corners.push_back(first + static_cast<int>(mesh.indices[i + k]));
      shade += mesh.vertices[mesh.indices[i + k]].shade / 3.0F;
    }
    surfaces.push_back({mesh.label, mesh.cover, white * shade});
  }
}

btScalar NearestHit::reportHit(const btVector3& normal, btScalar fraction, int, int triangle) {
  const Surface& surface = soup_.surfaces[static_cast<std::size_t>(triangle)];
  const Vector3d n(normal.x(), normal.y(), normal.z());
  const bool entering = n.dot(along_) < 0.0;
  if (surface.cover < 1.0F) {
    // A crown counts where the ray enters it: that it also leaves it adds no leaves.
    if (!entering || !HasLeafAt(from_ + fraction * along_, surface.cover)) return m_hitFraction;
  }
  hit_ = &surface;
  normal_ = entering ? n : -n;
  return fraction;
}

}  // namespace polnav::sim
