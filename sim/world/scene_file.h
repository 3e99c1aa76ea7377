// What is in a scene file that a user brings?
//
// glTF, OBJ and whatever else Assimp reads, as textured triangles of one grey reflectance. Colours
// become grey by their luminance; textures are decoded from sRGB, a material's factors taken as
// linear (glTF says so; OBJ's Kd is treated alike). Texture sides become powers of two.
// Right-handed, the file's y or z axis up; where its x axis points is yaw_deg counter-clockwise
// from east. Not in it: lights, cameras, animation, transparency, normal maps. One side of a
// triangle is drawn, the one from which its corners run counter-clockwise. Vehicles drive on
// Polnav's terrain whatever the file's ground is like.
#pragma once

#include <Eigen/Core>
#include <string>

#include "sim/world/scene_builder.h"

namespace polnav::sim {

// YAML keys = field names.
struct SceneFileOptions {
  std::string path;      // relative to the scenario file
  double scale = 1.0;    // of the file's units to metres
  std::string up = "y";  // the file's upward axis; glTF and most OBJ files have y
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // of the file's origin in W
  double yaw_deg = 0.0;                                  // counter-clockwise from above
  bool with_plaza = false;  // true: the file adds to the plaza; false: it stands in its place
  std::string folder;       // no key: where a relative path starts, set by who reads the scenario

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("path", path);
    v("scale", scale, {.min = 1e-4, .max = 1e4});
    v("up", up, {"y", "z"});
    v("position_m", position_m, {.min = -1e4, .max = 1e4});
    v("yaw_deg", yaw_deg, {.min = -360.0, .max = 360.0});
    v("with_plaza", with_plaza);
  }
};

// Throws std::invalid_argument: no such file, not readable, without faces, a texture missing.
void AddSceneFile(const SceneFileOptions& options, SceneBuilder& scene);

}  // namespace polnav::sim
