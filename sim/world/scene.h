// What is there to be seen? Triangles with textures, in W. The renderer draws it, nothing more.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "nav/api/geometry.h"
#include "nav/api/time.h"

namespace polnav::sim {

// What kind of thing a surface belongs to; the instance label of everything that stands still.
enum class Label : std::uint8_t {
  kSky = 0,
  kGround = 1,
  kBuilding = 2,
  kVegetation = 3,
  kStreetThing = 4,  // lamps, parked cars, benches, signs
  kStructure = 5,    // bridges, tunnels, walls
  kVehicle = 6,
  kPerson = 7,
  kUser = 8,  // of a scene file
};

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
  Label label = Label::kGround;
  float cover = 1.0F;  // share of what is behind that it hides from a sensor: foliage has gaps
};

// A car, a bus, a person: it moves. A is its own frame: origin on the ground below its middle, x
// forward, z up. The keys are in order of time; see sim/world/actor.h for what lies between them.
struct ActorKey {
  nav::TimeNs stamp = 0;
  nav::Pose T_WA;
};

struct Actor {
  std::string name;
  std::vector<Mesh> meshes;  // in A instead of W
  std::vector<ActorKey> path;
};

struct Scene {
  std::vector<Mesh> meshes;
  std::vector<Actor> actors;
  std::vector<cv::Mat> textures;  // CV_8UC1, linear reflectance, sides powers of two; tiled
  // Of each texture: how many corners it has to follow, over those of a rich one. Where no picture
  // is drawn it stands for the texture.
  std::vector<double> detail;
};

}  // namespace polnav::sim
