#include "sim/world/scene_file.h"

#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

#include "nav/api/geometry.h"

namespace polnav::sim {
namespace {

using Eigen::Vector3d;

struct Material {
  int texture = 0;
  double albedo = 1.0;
};

double LinearOfSrgb(double value) {
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

double Luminance(double r, double g, double b) { return 0.2126 * r + 0.7152 * g + 0.0722 * b; }

// The nearest power of two that is not above what is worth storing.
int SideFor(int side_px) {
  constexpr int kLargest = 2048;
  const int power = 1 << static_cast<int>(std::lround(std::log2(std::max(1, side_px))));
  return std::min(power, kLargest);
}

cv::Mat GreyTexture(const cv::Mat& bgr) {
  std::array<float, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i) {
    linear[i] = static_cast<float>(LinearOfSrgb(static_cast<double>(i) / 255.0));
  }
  cv::Mat grey(bgr.size(), CV_32FC1);
  for (int row = 0; row < bgr.rows; ++row) {
    for (int col = 0; col < bgr.cols; ++col) {
      const auto& pixel = bgr.at<cv::Vec3b>(row, col);
      grey.at<float>(row, col) =
          static_cast<float>(Luminance(linear[pixel[2]], linear[pixel[1]], linear[pixel[0]]));
    }
  }
  cv::Mat resized;
  const cv::Size size(SideFor(bgr.cols), SideFor(bgr.rows));
  const bool shrinks = size.area() < bgr.size().area();
  cv::resize(grey, resized, size, 0, 0, shrinks ? cv::INTER_AREA : cv::INTER_LINEAR);
  cv::Mat texels;
  resized.convertTo(texels, CV_8UC1, 255.0);
  return texels;
}

class SceneFile {
 public:
  SceneFile(const SceneFileOptions& options, SceneBuilder& builder)
      : options_(options), builder_(builder), path_(options.path) {
    if (path_.is_relative() && !options.folder.empty()) path_ = options.folder / path_;
    if (!std::filesystem::is_regular_file(path_)) Fail("there is no such file");
    // Strictly triangles, each node's place worked into its vertices; v runs down as in images.
    scene_ = importer_.ReadFile(
        path_.string(), aiProcess_Triangulate | aiProcess_PreTransformVertices |
                            aiProcess_GenSmoothNormals | aiProcess_JoinIdenticalVertices |
                            aiProcess_FindDegenerates | aiProcess_SortByPType | aiProcess_FlipUVs);
    if (scene_ == nullptr) Fail(importer_.GetErrorString());
  }

  void Add() {
    builder_.SetLabel(Label::kUser);
    std::size_t faces = 0;
    for (unsigned i = 0; i < scene_->mNumMeshes; ++i) {
      const aiMesh& mesh = *scene_->mMeshes[i];
      if (mesh.mPrimitiveTypes != aiPrimitiveType_TRIANGLE) continue;
      faces += mesh.mNumFaces;
      AddMesh(mesh, MaterialOf(mesh.mMaterialIndex));
    }
    if (faces == 0) Fail("it holds no faces");
  }

 private:
  [[noreturn]] void Fail(const std::string& message) const {
    throw std::invalid_argument("scene file '" + path_.string() + "': " + message);
  }

  // A mesh a square of ground: corners that triangles share stay shared within it.
  void AddMesh(const aiMesh& source, const Material& material) {
    // Once for the meshes to be there, whose places in memory then stay.
    for (unsigned f = 0; f < source.mNumFaces; ++f) {
      builder_.MeshAt(Middle(source, source.mFaces[f]), material.texture);
    }
    std::map<std::pair<const Mesh*, unsigned>, std::uint32_t> known;
    for (unsigned f = 0; f < source.mNumFaces; ++f) {
      const aiFace& face = source.mFaces[f];
      Mesh& mesh = builder_.MeshAt(Middle(source, face), material.texture);
      mesh.albedo = static_cast<float>(material.albedo);
      for (int k = 0; k < 3; ++k) {
        const unsigned index = face.mIndices[k];
        const auto next = static_cast<std::uint32_t>(mesh.vertices.size());
        const auto [entry, is_new] = known.try_emplace({&mesh, index}, next);
        if (is_new) mesh.vertices.push_back(VertexOf(source, index));
        mesh.indices.push_back(entry->second);
      }
    }
  }

  [[nodiscard]] Vector3d Middle(const aiMesh& source, const aiFace& triangle) const {
    Vector3d sum = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) sum += Place(source.mVertices[triangle.mIndices[k]]);
    return sum / 3.0;
  }

  [[nodiscard]] Vertex VertexOf(const aiMesh& source, unsigned index) const {
    Vertex vertex;
    vertex.p_W_m = Place(source.mVertices[index]).cast<float>();
    const aiVector3D& n = source.mNormals[index];
    vertex.normal_W = Turn(Vector3d(n.x, n.y, n.z)).normalized().cast<float>();
    vertex.uv.setZero();
    if (source.HasTextureCoords(0)) {
      const aiVector3D& uv = source.mTextureCoords[0][index];
      vertex.uv = {uv.x, uv.y};
    }
    return vertex;
  }

  [[nodiscard]] Vector3d Turn(const Vector3d& v) const {
    const Vector3d upright = options_.up == "y" ? Vector3d(v.x(), -v.z(), v.y()) : v;
    return Eigen::AngleAxisd(nav::DegToRad(options_.yaw_deg), Vector3d::UnitZ()) * upright;
  }

  [[nodiscard]] Vector3d Place(const aiVector3D& p) const {
    return options_.position_m + options_.scale * Turn(Vector3d(p.x, p.y, p.z));
  }

  // Every material gets a texture of its own: a mesh is told apart by it, and has one albedo.
  Material MaterialOf(unsigned index) {
    const auto [entry, is_new] = materials_.try_emplace(index);
    if (!is_new) return entry->second;
    const aiMaterial& source = *scene_->mMaterials[index];
    aiColor4D color(1.0F, 1.0F, 1.0F, 1.0F);
    if (source.Get(AI_MATKEY_BASE_COLOR, color) != AI_SUCCESS) {
      source.Get(AI_MATKEY_COLOR_DIFFUSE, color);
    }
    entry->second.albedo = std::clamp(Luminance(color.r, color.g, color.b), 0.0, 1.0);
    const cv::Mat texture = TextureOf(source);
    // What is of one grey has corners at its edges only.
    const double detail = texture.total() == 1 ? 0.2 : 1.0;
    entry->second.texture = builder_.AddTexture(texture, detail);
    return entry->second;
  }

  [[nodiscard]] cv::Mat TextureOf(const aiMaterial& source) const {
    aiString name;
    if (source.GetTexture(aiTextureType_BASE_COLOR, 0, &name) != AI_SUCCESS &&
        source.GetTexture(aiTextureType_DIFFUSE, 0, &name) != AI_SUCCESS) {
      return {1, 1, CV_8UC1, cv::Scalar(255)};
    }
    const aiString material = [&] {
      aiString text;
      source.Get(AI_MATKEY_NAME, text);
      return text;
    }();
    cv::Mat bgr;
    if (const aiTexture* inside = scene_->GetEmbeddedTexture(name.C_Str())) {
      if (inside->mHeight == 0) {
        const cv::Mat bytes(1, static_cast<int>(inside->mWidth), CV_8UC1, inside->pcData);
        bgr = cv::imdecode(bytes, cv::IMREAD_COLOR);
      }
    } else {
      std::string file = name.C_Str();
      std::replace(file.begin(), file.end(), '\\', '/');
      bgr = cv::imread((path_.parent_path() / file).string(), cv::IMREAD_COLOR);
    }
    if (bgr.empty()) {
      Fail("the texture '" + std::string(name.C_Str()) + "' of its material '" + material.C_Str() +
           "' is missing or no image");
    }
    return GreyTexture(bgr);
  }

  const SceneFileOptions& options_;
  SceneBuilder& builder_;
  std::filesystem::path path_;
  Assimp::Importer importer_;
  const aiScene* scene_ = nullptr;
  std::map<unsigned, Material> materials_;
};

}  // namespace

void AddSceneFile(const SceneFileOptions& options, SceneBuilder& scene) {
  SceneFile(options, scene).Add();
}

}  // namespace polnav::sim
