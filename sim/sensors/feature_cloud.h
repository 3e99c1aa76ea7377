// Which points of the scene could a camera follow?
//
// A point stands for a corner of some size. The larger it is, the further away it can be told from
// its surroundings: its reach. On a surface that is nearest to the drive at a distance r there are
//   points_per_sr / r^2   points a square metre, of which a share (r / R)^2 reach further than R,
// so that from any distance, and for a slanted surface by the same rule with the distance
//   R = distance / sqrt(cosine of the angle between line of sight and normal),
// a steradian of the picture holds points_per_sr of them. Plain surfaces hold fewer
// (Scene::detail). Not in it: where a texture has its corners, edges of things, repeated patterns.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sim/random.h"
#include "sim/sensors/feature_options.h"
#include "sim/world/scene.h"

namespace polnav::sim {

struct FeaturePoint {
  Eigen::Vector3f p_m;     // in W, or in A on an actor
  Eigen::Vector3f normal;  // likewise, unit
  float reach_m;
  float brightness;  // over the brightest thing there is, uniform from 0 to 1
};

// Points near each other that face the same way, in order of falling reach.
struct FeaturePatch {
  int actor = -1;                                      // index into Scene::actors; -1 stands still
  Eigen::Vector3f center_m = Eigen::Vector3f::Zero();  // in W or in A
  float radius_m = 0.0F;
  Eigen::Vector3f axis = Eigen::Vector3f::UnitZ();  // the normals' mean
  float spread = 0.0F;                              // sine of the widest angle from it to a normal
  float depth_m = 0.0F;                             // from the middle to the rearmost, along axis
  std::uint32_t begin = 0;                          // of FeatureCloud::points
  std::uint32_t end = 0;
};

struct FeatureCloud {
  std::vector<FeaturePoint> points;
  std::vector<FeaturePatch> patches;
};

// viewpoints_W_m: where the cameras come by. Surfaces further from all of them than the points can
// be seen have none.
[[nodiscard]] FeatureCloud DrawFeatureCloud(const Scene& scene, const FeatureOptions& options,
                                            const std::vector<Eigen::Vector3d>& viewpoints_W_m,
                                            std::uint64_t seed, std::uint64_t trial);

}  // namespace polnav::sim
