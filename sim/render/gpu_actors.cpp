#include "sim/render/gpu_actors.h"

#include <algorithm>
#include <cstddef>

#include "sim/render/gpu_buffers.h"
#include "sim/world/actor.h"

namespace polnav::sim {
namespace {

struct ActorVertex {
  Eigen::Vector3f p_A;
  Eigen::Vector2f uv;
  float albedo;
  Eigen::Vector3f normal_A;
};

// About all of the meshes.
BoundingSphere SphereAround(const std::vector<Mesh>& meshes) {
  Mesh all;
  for (const Mesh& mesh : meshes) {
    all.vertices.insert(all.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  }
  return all.vertices.empty() ? BoundingSphere{Eigen::Vector3d::Zero()} : SphereAround(all);
}

}  // namespace

GpuActors::GpuActors(const GlFunctions& gl, const std::vector<Actor>& actors,
                     const std::vector<GLuint>& textures)
    : gl_(gl) {
  std::vector<ActorVertex> vertices;
  std::vector<std::uint32_t> indices;
  for (const Actor& actor : actors) {
    Loaded loaded{.path = actor.path, .sphere = SphereAround(actor.meshes)};
    for (const Mesh& mesh : actor.meshes) {
      loaded.ranges.push_back({textures.at(static_cast<std::size_t>(mesh.texture)), indices.size(),
                               mesh.indices.size()});
      const auto base = static_cast<std::uint32_t>(vertices.size());
      for (const std::uint32_t index : mesh.indices) indices.push_back(base + index);
      for (const Vertex& v : mesh.vertices) {
        vertices.push_back({v.p_W_m, v.uv, mesh.albedo * v.shade, v.normal_W});
      }
    }
    actors_.push_back(std::move(loaded));
  }
  array_ = LoadBuffers(gl, vertices, indices).array;
  Attribute(gl, 0, 3, sizeof(ActorVertex), offsetof(ActorVertex, p_A));
  Attribute(gl, 1, 2, sizeof(ActorVertex), offsetof(ActorVertex, uv));
  Attribute(gl, 2, 1, sizeof(ActorVertex), offsetof(ActorVertex, albedo));
  Attribute(gl, 3, 3, sizeof(ActorVertex), offsetof(ActorVertex, normal_A));
}

std::vector<GpuActors::Placed> GpuActors::At(nav::TimeNs stamp) const {
  std::vector<Placed> there;
  for (std::size_t i = 0; i < actors_.size(); ++i) {
    const auto T_WA = PoseOf(actors_[i].path, stamp);
    if (!T_WA || actors_[i].ranges.empty()) continue;
    Eigen::Matrix4d W_from_A = Eigen::Matrix4d::Identity();
    W_from_A.topLeftCorner<3, 3>() = T_WA->q.toRotationMatrix();
    W_from_A.topRightCorner<3, 1>() = T_WA->p;
    there.push_back({i,
                     W_from_A.cast<float>(),
                     {*T_WA * actors_[i].sphere.center, actors_[i].sphere.radius_m}});
  }
  return there;
}

void GpuActors::Draw(const Placed& placed, const SurfacePrograms& programs) const {
  gl_.BindVertexArray(array_);
  programs.Place(placed.W_from_A);
  for (const Range& range : actors_[placed.actor].ranges) {
    gl_.BindTexture(GL_TEXTURE_2D, range.texture);
    DrawIndexed(gl_, range.first, range.count);
  }
}

void GpuActors::DrawDepth(const Placed& placed, GLint W_from_A) const {
  gl_.BindVertexArray(array_);
  gl_.UniformMatrix4fv(W_from_A, 1, GL_FALSE, placed.W_from_A.data());
  const std::vector<Range>& ranges = actors_[placed.actor].ranges;
  DrawIndexed(gl_, ranges.front().first,
              ranges.back().first + ranges.back().count - ranges.front().first);
}

}  // namespace polnav::sim
