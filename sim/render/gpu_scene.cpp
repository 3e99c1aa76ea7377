#include "sim/render/gpu_scene.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>

#include "sim/render/gpu_buffers.h"

namespace polnav::sim {
namespace {

struct LitVertex {
  Eigen::Vector3f p_W;
  Eigen::Vector2f uv;
  Eigen::Vector2f light;  // from sky and from sun
};

// Triangles on their way into the buffers. A vertex in the sun and in the shade is two.
class LitMeshes {
 public:
  LitMeshes(const Lighting& lighting, const SunLitTriangles& sunlit)
      : lighting_(lighting), sunlit_(sunlit) {}

  // Appends the mesh, what needs the shadow map last, and returns where that begins. sun_box grows
  // by what gets sun, in the axes along it.
  std::size_t Append(const Mesh& mesh, const Eigen::Matrix3d& axes, Eigen::AlignedBox3d& sun_box) {
    std::vector<std::array<std::uint32_t, 2>> placed(mesh.vertices.size(), {kNone, kNone});
    std::vector<std::uint32_t> edges;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      const Lit lit = LightOf(mesh, i);
      const bool any = lit.corner[0] || lit.corner[1] || lit.corner[2];
      for (std::size_t k = 0; k < 3; ++k) {
        const Vertex& v = mesh.vertices[mesh.indices[i + k]];
        std::uint32_t& at = placed[mesh.indices[i + k]][lit.corner[k] ? 1 : 0];
        if (at == kNone) at = Place(mesh, v, lit.corner[k]);
        (lit.edge ? edges : indices).push_back(at);
        if (any) sun_box.extend(axes * v.p_W_m.cast<double>());
      }
    }
    const std::size_t middle = indices.size();
    indices.insert(indices.end(), edges.begin(), edges.end());
    return middle;
  }

  std::vector<LitVertex> vertices;
  std::vector<std::uint32_t> indices;

 private:
  static constexpr std::uint32_t kNone = 0xffffffffU;

  // Which corners get sun, and whether only the shadow map knows where in between it ends.
  struct Lit {
    std::array<bool, 3> corner{};
    bool edge = false;
  };

  // A triangle so small that the map's own softness is no sharper is shaded from corner to corner.
  [[nodiscard]] Lit LightOf(const Mesh& mesh, std::size_t first_index) const {
    constexpr float kSmall_m = 0.8F;
    std::array<Eigen::Vector3f, 3> p;
    bool faces_sun = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vertex& v = mesh.vertices[mesh.indices[first_index + k]];
      p[k] = v.p_W_m;
      faces_sun = faces_sun || lighting_.FromSun(v.normal_W.cast<double>()) > 0.0;
    }
    if (!faces_sun) return {};
    const float longest_m =
        std::max({(p[1] - p[0]).norm(), (p[2] - p[1]).norm(), (p[0] - p[2]).norm()});
    if (longest_m < kSmall_m) {
      return {{sunlit_.IsLit(p[0]), sunlit_.IsLit(p[1]), sunlit_.IsLit(p[2])}, false};
    }
    const SunLitness light = sunlit_.Of(p);
    const bool lit = light != SunLitness::kDark;
    return {{lit, lit, lit}, light == SunLitness::kMixed};
  }

  std::uint32_t Place(const Mesh& mesh, const Vertex& v, bool lit) {
    const Eigen::Vector3d normal = v.normal_W.cast<double>();
    const float albedo = mesh.albedo * v.shade;
    vertices.push_back(
        {v.p_W_m, v.uv,
         albedo * Eigen::Vector2f(static_cast<float>(lighting_.FromSky(normal)),
                                  lit ? static_cast<float>(lighting_.FromSun(normal)) : 0.0F)});
    return static_cast<std::uint32_t>(vertices.size()) - 1;
  }

  const Lighting& lighting_;
  const SunLitTriangles& sunlit_;
};

// Shells about the eye that are drawn one after the other.
int ShellOf(double nearest_m) {
  constexpr std::array kEnds_m = {4.0, 12.0, 30.0, 70.0};
  return static_cast<int>(std::lower_bound(kEnds_m.begin(), kEnds_m.end(), nearest_m) -
                          kEnds_m.begin());
}

}  // namespace

BoundingSphere SphereAround(const Mesh& mesh) {
  Eigen::Vector3f low = mesh.vertices.front().p_W_m;
  Eigen::Vector3f high = low;
  for (const Vertex& v : mesh.vertices) {
    low = low.cwiseMin(v.p_W_m);
    high = high.cwiseMax(v.p_W_m);
  }
  const Eigen::Vector3f center = 0.5F * (low + high);
  float radius = 0.0F;
  for (const Vertex& v : mesh.vertices) radius = std::max(radius, (v.p_W_m - center).norm());
  return {center.cast<double>(), radius};
}

// Bilinear within the nearest mip level: a second level costs a fifth of the frame. Half a level
// towards the sharper side: the road, seen at a grazing angle, would blur sideways otherwise.
std::vector<GLuint> LoadTextures(const GlFunctions& gl, const std::vector<cv::Mat>& textures) {
  constexpr float kLevelBias = -0.5F;
  std::vector<GLuint> ids(textures.size());
  gl.GenTextures(static_cast<GLsizei>(ids.size()), ids.data());
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  for (std::size_t i = 0; i < textures.size(); ++i) {
    const cv::Mat& texels = textures[i];
    if (texels.type() != CV_8UC1 || !texels.isContinuous()) {
      throw std::logic_error("a texture is not a continuous CV_8UC1");
    }
    gl.BindTexture(GL_TEXTURE_2D, ids[i]);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, texels.cols, texels.rows, 0, GL_RED, GL_UNSIGNED_BYTE,
                  texels.data);
    gl.GenerateMipmap(GL_TEXTURE_2D);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    gl.TexParameterf(GL_TEXTURE_2D, GL_TEXTURE_LOD_BIAS, kLevelBias);
  }
  return ids;
}

GpuScene::GpuScene(const GlFunctions& gl, const Scene& scene, const std::vector<GLuint>& textures,
                   const Lighting& lighting, const SunLitTriangles& sunlit)
    : gl_(gl) {
  const Eigen::Matrix3d axes = AxesAlongSun(lighting.sun_W());
  LitMeshes lit(lighting, sunlit);
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.vertices.empty()) continue;
    const std::size_t first = lit.indices.size();
    Eigen::AlignedBox3d sun_box;
    const std::size_t middle = lit.Append(mesh, axes, sun_box);
    ranges_.push_back({SphereAround(mesh),
                       mesh.draw_distance_m,
                       textures.at(static_cast<std::size_t>(mesh.texture)),
                       sun_box,
                       {first, middle - first},
                       {middle, lit.indices.size() - middle}});
  }
  array_ = LoadBuffers(gl, lit.vertices, lit.indices).array;
  Attribute(gl, 0, 3, sizeof(LitVertex), offsetof(LitVertex, p_W));
  Attribute(gl, 1, 2, sizeof(LitVertex), offsetof(LitVertex, uv));
  Attribute(gl, 2, 2, sizeof(LitVertex), offsetof(LitVertex, light));
}

void GpuScene::Cull(const nav::Pose& T_CW, const Frustum& frustum) {
  visible_.clear();
  for (const Range& range : ranges_) {
    const Eigen::Vector3d center_C = T_CW * range.sphere.center;
    if (!frustum.MayShow(center_C, range.sphere.radius_m)) continue;
    const double distance = center_C.norm();
    if (distance - range.sphere.radius_m > range.draw_distance_m) continue;
    visible_.push_back({ShellOf(distance - range.sphere.radius_m), &range});
  }
  std::sort(visible_.begin(), visible_.end(), [](const Visible& a, const Visible& b) {
    if (a.shell != b.shell) return a.shell < b.shell;
    if (a.range->texture != b.range->texture) return a.range->texture < b.range->texture;
    return a.range < b.range;
  });
}

// A call costs llvmpipe as much as some hundred triangles: one for all of a shell and a texture.
void GpuScene::DrawBatch() {
  gl_.BindVertexArray(array_);
  for (std::size_t i = 0; i < batch_.size();) {
    const Visible& first = batch_[i].visible;
    counts_.clear();
    offsets_.clear();
    for (; i < batch_.size() && batch_[i].visible.shell == first.shell &&
           batch_[i].visible.range->texture == first.range->texture;
         ++i) {
      counts_.push_back(static_cast<GLsizei>(batch_[i].indices.count));
      offsets_.push_back(BufferOffset(batch_[i].indices.first * sizeof(std::uint32_t)));
    }
    gl_.BindTexture(GL_TEXTURE_2D, first.range->texture);
    gl_.MultiDrawElements(GL_TRIANGLES, counts_.data(), GL_UNSIGNED_INT, offsets_.data(),
                          static_cast<GLsizei>(counts_.size()));
  }
}

GpuTriangles::GpuTriangles(const GlFunctions& gl, const std::vector<Vertex>& vertices,
                           const std::vector<std::uint32_t>& indices)
    : gl_(gl), index_count_(indices.size()) {
  const GpuBuffers buffers = LoadBuffers(gl, vertices, indices);
  array_ = buffers.array;
  vertices_ = buffers.vertices;
  Attribute(gl, 0, 3, sizeof(Vertex), offsetof(Vertex, position));
  Attribute(gl, 1, 1, sizeof(Vertex), offsetof(Vertex, radiance));
}

void GpuTriangles::Update(const std::vector<Vertex>& vertices) const {
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_);
  gl_.BufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)),
                    vertices.data());
}

void GpuTriangles::Draw() const { Draw(0, index_count_); }

void GpuTriangles::Draw(std::size_t first_index, std::size_t count) const {
  gl_.BindVertexArray(array_);
  DrawIndexed(gl_, first_index, count);
}

}  // namespace polnav::sim
