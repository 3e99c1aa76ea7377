// What is there to be seen? Triangles with textures, in W. The renderer draws it, nothing more.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace polnav::sim {

struct Vertex {
  Eigen::Vector3f p_W_m;
  Eigen::Vector3f normal_W;
  Eigen::Vector2f uv;  // in texture repeats
  float shade = 1.0F;  // scales the texture here: large-scale variation that no texture repeats
};

// One draw call: triangles near each other that share a texture, so that it can be culled whole.
struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  // three a triangle, counter-clockwise seen from outside
  int texture = 0;                     // index into Scene::textures
  float albedo = 1.0F;                 // scales the texture
  float draw_distance_m = 1e6F;        // small things are left out beyond
};

struct Scene {
  std::vector<Mesh> meshes;
  std::vector<cv::Mat> textures;  // CV_8UC1, linear reflectance, sides powers of two; tiled
};

}  // namespace polnav::sim
