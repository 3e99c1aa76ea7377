#include "sim/world/sweep.h"

#include <Eigen/Geometry>

namespace polnav::sim {

using Eigen::Vector2d;
using Eigen::Vector3d;

void AddSweep(const StreetFrame& street, const Sweep& sweep, const UvOf& uv_of,
              const ShadeOf& shade_of, SceneBuilder& scene) {
  const auto point = [&](double s, const Rib& rib) {
    return street.At(s, rib.offset_m, rib.lift_m);
  };
  const std::vector<Rib>& ribs = sweep.ribs;
  const double middle = 0.5 * (sweep.s0_m + sweep.s1_m);
  Mesh& mesh = scene.MeshAt(street.At(middle, ribs.front().offset_m), sweep.texture);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto stride = static_cast<std::uint32_t>(ribs.size());
  const double step = (sweep.s1_m - sweep.s0_m) / sweep.rows;
  for (int row = 0; row <= sweep.rows; ++row) {
    const double s = sweep.s0_m + step * row;
    for (std::size_t k = 0; k < ribs.size(); ++k) {
      const Vector3d p = point(s, ribs[k]);
      const std::size_t near = k + 1 < ribs.size() ? k : k - 1;
      const Vector3d across = point(s, ribs[near + 1]) - point(s, ribs[near]);
      const Vector3d along = point(s + 0.5 * step, ribs[near]) - point(s - 0.5 * step, ribs[near]);
      const Vector2d uv = uv_of(static_cast<double>(row) / sweep.rows, static_cast<int>(k), p);
      mesh.vertices.push_back({p.cast<float>(), along.cross(across).normalized().cast<float>(),
                               uv.cast<float>(), static_cast<float>(shade_of(s, ribs[k], p))});
    }
  }
  for (std::uint32_t row = 0; row < static_cast<std::uint32_t>(sweep.rows); ++row) {
    for (std::uint32_t k = 0; k + 1 < stride; ++k) {
      const std::uint32_t a = first + row * stride + k;
      const std::uint32_t b = a + stride;
      mesh.indices.insert(mesh.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
    }
  }
}

}  // namespace polnav::sim
