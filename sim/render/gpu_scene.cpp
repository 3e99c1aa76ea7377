#include "sim/render/gpu_scene.h"

#include <algorithm>
#include <cstddef>
#include <stdexcept>

namespace polnav::sim {
namespace {

struct LitVertex {
  Eigen::Vector3f p_W;
  Eigen::Vector2f uv;
  float light;
};

void* Offset(std::size_t bytes) { return reinterpret_cast<void*>(bytes); }

void Attribute(const GlFunctions& gl, GLuint location, GLint components, std::size_t stride,
               std::size_t offset) {
  gl.EnableVertexAttribArray(location);
  gl.VertexAttribPointer(location, components, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                         Offset(offset));
}

// A vertex array with its two buffers bound and filled.
template <typename V>
GLuint Load(const GlFunctions& gl, const std::vector<V>& vertices,
            const std::vector<std::uint32_t>& indices) {
  GLuint array = 0;
  GLuint buffers[2];
  gl.GenVertexArrays(1, &array);
  gl.GenBuffers(2, buffers);
  gl.BindVertexArray(array);
  gl.BindBuffer(GL_ARRAY_BUFFER, buffers[0]);
  gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(V)),
                vertices.data(), GL_STATIC_DRAW);
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
  gl.BufferData(GL_ELEMENT_ARRAY_BUFFER,
                static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)), indices.data(),
                GL_STATIC_DRAW);
  return array;
}

// Centre and radius of a sphere about the mesh's bounding box.
std::pair<Eigen::Vector3f, float> BoundingSphere(const Mesh& mesh) {
  Eigen::Vector3f low = mesh.vertices.front().p_W_m;
  Eigen::Vector3f high = low;
  for (const Vertex& v : mesh.vertices) {
    low = low.cwiseMin(v.p_W_m);
    high = high.cwiseMax(v.p_W_m);
  }
  const Eigen::Vector3f center = 0.5F * (low + high);
  float radius = 0.0F;
  for (const Vertex& v : mesh.vertices) radius = std::max(radius, (v.p_W_m - center).norm());
  return {center, radius};
}

}  // namespace

GpuScene::GpuScene(const GlFunctions& gl, const Scene& scene, const Lighting& lighting) : gl_(gl) {
  LoadTextures(scene.textures);
  std::vector<LitVertex> vertices;
  std::vector<std::uint32_t> indices;
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.vertices.empty()) continue;
    const auto [center, radius] = BoundingSphere(mesh);
    ranges_.push_back({center.cast<double>(), radius, mesh.draw_distance_m,
                       textures_.at(static_cast<std::size_t>(mesh.texture)),
                       static_cast<GLsizei>(mesh.indices.size()), indices.size()});
    const auto base = static_cast<std::uint32_t>(vertices.size());
    for (const std::uint32_t index : mesh.indices) indices.push_back(base + index);
    for (const Vertex& v : mesh.vertices) {
      const auto light = static_cast<float>(lighting.OfWhite(v.normal_W.cast<double>()));
      vertices.push_back({v.p_W_m, v.uv, light * mesh.albedo * v.shade});
    }
  }
  vertices_ = Load(gl, vertices, indices);
  Attribute(gl, 0, 3, sizeof(LitVertex), offsetof(LitVertex, p_W));
  Attribute(gl, 1, 2, sizeof(LitVertex), offsetof(LitVertex, uv));
  Attribute(gl, 2, 1, sizeof(LitVertex), offsetof(LitVertex, light));
}

// Bilinear within the nearest mip level: a second level costs a fifth of the frame. Half a level
// towards the sharper side: the road, seen at a grazing angle, would blur sideways otherwise.
void GpuScene::LoadTextures(const std::vector<cv::Mat>& textures) {
  constexpr float kLevelBias = -0.5F;
  textures_.resize(textures.size());
  gl_.GenTextures(static_cast<GLsizei>(textures_.size()), textures_.data());
  gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  for (std::size_t i = 0; i < textures.size(); ++i) {
    const cv::Mat& texels = textures[i];
    if (texels.type() != CV_8UC1 || !texels.isContinuous()) {
      throw std::logic_error("a texture is not a continuous CV_8UC1");
    }
    gl_.BindTexture(GL_TEXTURE_2D, textures_[i]);
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, texels.cols, texels.rows, 0, GL_RED, GL_UNSIGNED_BYTE,
                   texels.data);
    gl_.GenerateMipmap(GL_TEXTURE_2D);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    gl_.TexParameterf(GL_TEXTURE_2D, GL_TEXTURE_LOD_BIAS, kLevelBias);
  }
}

void GpuScene::Draw(const nav::Pose& T_CW, const Frustum& frustum) {
  visible_.clear();
  for (const Range& range : ranges_) {
    const Eigen::Vector3d center_C = T_CW * range.center_W;
    if (!frustum.MayShow(center_C, range.radius_m)) continue;
    const double distance = center_C.norm();
    if (distance - range.radius_m > range.draw_distance_m) continue;
    visible_.emplace_back(distance, &range);
  }
  std::sort(visible_.begin(), visible_.end());
  gl_.BindVertexArray(vertices_);
  for (const auto& [distance, range] : visible_) {
    gl_.BindTexture(GL_TEXTURE_2D, range->texture);
    gl_.DrawElements(GL_TRIANGLES, range->index_count, GL_UNSIGNED_INT,
                     Offset(range->first_index * sizeof(std::uint32_t)));
  }
}

GpuTriangles::GpuTriangles(const GlFunctions& gl, const std::vector<Vertex>& vertices,
                           const std::vector<std::uint32_t>& indices)
    : gl_(gl),
      vertices_(Load(gl, vertices, indices)),
      index_count_(static_cast<GLsizei>(indices.size())) {
  Attribute(gl, 0, 3, sizeof(Vertex), offsetof(Vertex, position));
  Attribute(gl, 1, 1, sizeof(Vertex), offsetof(Vertex, radiance));
}

void GpuTriangles::Draw() const {
  gl_.BindVertexArray(vertices_);
  gl_.DrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, Offset(0));
}

}  // namespace polnav::sim
