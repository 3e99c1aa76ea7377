#include "sim/world/scene_file.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

namespace polnav::sim {
namespace {

// A folder that goes with the test, to write scenes into.
class SceneFileTest : public testing::Test {
 protected:
  SceneFileTest() {
    std::string name = (std::filesystem::temp_directory_path() / "polnav-scene-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    folder_ = name;
  }
  ~SceneFileTest() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  // One square metre standing upright in the file's xy plane, seen from +z.
  void WriteSquare(const std::string& material) const {
    Write("square.obj",
          "mtllib square.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
          "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl wall\nf 1/1 2/2 3/3 4/4\n");
    Write("square.mtl", "newmtl wall\n" + material);
  }
  [[nodiscard]] Scene Load(SceneFileOptions options) const {
    options.folder = folder_.string();
    SceneBuilder builder;
    AddSceneFile(options, builder);
    return builder.Take();
  }
  [[nodiscard]] std::string ErrorOf(const std::string& name) const {
    try {
      (void)Load({.path = name});
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "no error";
  }

  std::filesystem::path folder_;
};

// The file's y is up and its z looks south; scaled by two, turned left by a right angle, moved.
TEST_F(SceneFileTest, PutsAnObjFileWhereItIsToldTo) {
  WriteSquare("Kd 0.5 0.5 0.5\n");
  const Scene scene =
      Load({.path = "square.obj", .scale = 2.0, .position_m = {10.0, 20.0, 1.0}, .yaw_deg = 90.0});
  ASSERT_EQ(scene.meshes.size(), 1U);
  const Mesh& mesh = scene.meshes[0];
  EXPECT_EQ(mesh.label, Label::kUser);
  EXPECT_EQ(mesh.indices.size(), 6U);
  EXPECT_EQ(mesh.vertices.size(), 4U);
  EXPECT_NEAR(mesh.albedo, 0.5, 1e-6);
  for (const Vertex& v : mesh.vertices) {
    EXPECT_NEAR(v.p_W_m.x(), 10.0F, 1e-5F);
    EXPECT_GE(v.p_W_m.y(), 20.0F - 1e-5F);
    EXPECT_LE(v.p_W_m.y(), 22.0F + 1e-5F);
    EXPECT_GE(v.p_W_m.z(), 1.0F - 1e-5F);
    EXPECT_LE(v.p_W_m.z(), 3.0F + 1e-5F);
    EXPECT_LT((v.normal_W - Eigen::Vector3f::UnitX()).norm(), 1e-5F);
    // Row 0 of a texture is its top: v runs down from the upper edge.
    EXPECT_NEAR(v.uv.y(), v.p_W_m.z() > 2.0F ? 0.0F : 1.0F, 1e-5F);
  }
}

// Red 255, green 128, blue 0 in sRGB: 0.2126 + 0.7152 * 0.2159 = 0.3670 of white.
TEST_F(SceneFileTest, MakesATextureGreyLinearAndAPowerOfTwo) {
  WriteSquare("Kd 1 1 1\nmap_Kd paint.png\n");
  cv::imwrite((folder_ / "paint.png").string(), cv::Mat(30, 100, CV_8UC3, cv::Scalar(0, 128, 255)));
  const Scene scene = Load({.path = "square.obj"});
  const cv::Mat& texture = scene.textures.at(static_cast<std::size_t>(scene.meshes[0].texture));
  EXPECT_EQ(texture.cols, 128);
  EXPECT_EQ(texture.rows, 32);
  EXPECT_NEAR(cv::mean(texture)[0], 255.0 * 0.3670, 1.0);
  EXPECT_NEAR(scene.meshes[0].albedo, 1.0, 1e-6);
}

// One triangle; positions and indices in a data URI: (0,0,0) (1,0,0) (0,1,0), then 0 1 2.
TEST_F(SceneFileTest, ReadsGltf) {
  Write("triangle.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
    "nodes":[{"mesh":0,"translation":[0,0,-3]}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]}],
    "materials":[{"name":"m","pbrMetallicRoughness":{"baseColorFactor":[0.2,0.2,0.2,1]}}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
                  "min":[0,0,0],"max":[1,1,0]},
                 {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],
    "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},
                   {"buffer":0,"byteOffset":36,"byteLength":6}],
    "buffers":[{"byteLength":42,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA"}]})");
  const Scene scene = Load({.path = "triangle.gltf"});
  ASSERT_EQ(scene.meshes.size(), 1U);
  EXPECT_NEAR(scene.meshes[0].albedo, 0.2, 1e-5);
  Eigen::Vector3f middle = Eigen::Vector3f::Zero();
  for (const Vertex& v : scene.meshes[0].vertices) middle += v.p_W_m / 3.0F;
  // The file's (1/3, 1/3, -3): x east, y up, z south.
  EXPECT_LT((middle - Eigen::Vector3f(1.0F / 3.0F, 3.0F, 1.0F / 3.0F)).norm(), 1e-5F);
}

TEST_F(SceneFileTest, SaysWhatIsWrongWithAFile) {
  EXPECT_NE(ErrorOf("nowhere.glb").find("nowhere.glb': there is no such file"), std::string::npos);
  Write("points.obj", "v 0 0 0\nv 1 0 0\n");
  EXPECT_NE(ErrorOf("points.obj"), "no error");
  Write("rubbish.gltf", "this is no JSON");
  EXPECT_NE(ErrorOf("rubbish.gltf"), "no error");
  Write("line.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n");
  EXPECT_NE(ErrorOf("line.obj").find("it holds no faces"), std::string::npos)
      << ErrorOf("line.obj");
  WriteSquare("map_Kd missing.png\n");
  EXPECT_NE(ErrorOf("square.obj").find("the texture 'missing.png' of its material 'wall'"),
            std::string::npos)
      << ErrorOf("square.obj");
}

}  // namespace
}  // namespace polnav::sim
