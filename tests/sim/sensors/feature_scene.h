// Walls before a stereo camera that stands at the origin and looks east, to test with.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <utility>
#include <vector>

#include "sim/sensors/feature_camera.h"
#include "sim/sensors/stereo_camera.h"
#include "sim/world/actor.h"

namespace polnav::sim {

// A square that faces west, `east_m` away, about (north, up) of its middle.
inline Mesh WallAt(double east_m, double half_side_m, double north_m = 0.0, double up_m = 0.0) {
  Mesh mesh;
  for (const auto& [n, u] : {std::pair{1.0, -1.0}, {-1.0, -1.0}, {-1.0, 1.0}, {1.0, 1.0}}) {
    const Eigen::Vector3d p(east_m, north_m + n * half_side_m, up_m + u * half_side_m);
    mesh.vertices.push_back({p.cast<float>(), -Eigen::Vector3f::UnitX(), Eigen::Vector2f::Zero()});
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

// At B's origin, level, without errors of any kind but those of its calibration.
inline StereoCameraOptions FaultlessOptions() {
  StereoCameraOptions options;
  options.position_m = {0.0, 0.06, 0.0};
  options.calibration_error.baseline_sigma_m = 0.0;  // eyes at 6 cm to the left and to the right
  options.pitch_down_deg = 0.0;
  options.features.pixel_sigma_px = 0.0;
  options.features.match_sigma_px = 0.0;
  options.features.patch_sigma_px = 0.0;
  options.features.loss_probability = 0.0;
  options.features.right_loss_probability = 0.0;
  options.features.outlier_share = 0.0;
  options.features.false_match_share = 0.0;
  return options;
}

// A feature camera and all that must outlive it. Frames 0.1 s apart.
struct FeatureRig {
  explicit FeatureRig(Scene scene_in, const StereoCameraOptions& options = FaultlessOptions(),
                      std::uint64_t seed = 1)
      : scene(std::move(scene_in)),
        occlusion(scene, [](const Eigen::Vector3d&) { return 1.0; }),
        truth(DrawTrueStereo(options, seed, 0)),
        camera(scene, occlusion,
               DrawFeatureCloud(scene, options.features, {Eigen::Vector3d::Zero()}, seed, 0), truth,
               options, seed, 0) {}

  [[nodiscard]] FeatureSightings Next(const nav::Pose& T_WB = {},
                                      const CameraConditions& conditions = {}) {
    stamp = static_cast<nav::TimeNs>(index) * (nav::kNsPerSecond / 10);
    return camera.See({.stamp = stamp, .index = index++, .T_WB = T_WB, .conditions = conditions});
  }

  // Where a point of the cloud is at the newest frame, and on whom: -1 stands still.
  [[nodiscard]] int ActorOf(std::uint32_t point) const {
    for (const FeaturePatch& patch : camera.cloud().patches) {
      if (point >= patch.begin && point < patch.end) return patch.actor;
    }
    return -2;
  }
  [[nodiscard]] Eigen::Vector3d PlaceOf(std::uint32_t point) const {
    const Eigen::Vector3d p = camera.cloud().points.at(point).p_m.cast<double>();
    const int actor = ActorOf(point);
    if (actor < 0) return p;
    return *PoseOf(scene.actors[static_cast<std::size_t>(actor)].path, stamp) * p;
  }

  Scene scene;
  Occlusion occlusion;
  nav::StereoCalibration truth;
  FeatureCamera camera;
  std::uint64_t index = 0;
  nav::TimeNs stamp = 0;
};

}  // namespace polnav::sim
