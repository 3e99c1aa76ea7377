// Which surface does each pixel of a camera look at, and how far away is it?
//
// The triangles that the renderer draws, met by the ray through each pixel's centre behind the
// lens: in doubles, in the calling thread, for ground truth, where a depth buffer's rounding, a
// driver's rules and the warp's interpolation have no say. Several times slower than the picture.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "nav/api/calibration.h"
#include "nav/api/geometry.h"
#include "nav/api/time.h"
#include "sim/render/frustum.h"
#include "sim/sensors/frame_truth.h"
#include "sim/world/scene.h"

namespace polnav::sim {

class TruthRaster {
 public:
  // The scene is copied.
  TruthRaster(const Scene& scene, const nav::CameraCalibration& camera);

  // In the raw image. Actors stand where they are at the stamp.
  [[nodiscard]] TruthLayers Draw(const nav::Pose& T_WC, nav::TimeNs stamp) const;

 private:
  // A mesh in its own frame: W, or an actor's.
  struct Shape {
    std::vector<Eigen::Vector3d> points;
    std::vector<std::uint32_t> indices;
    Eigen::Vector3d center;
    double radius_m = 0.0;
    double draw_distance_m = 0.0;
    int instance = 0;
  };
  [[nodiscard]] static Shape ShapeOf(const Mesh& mesh, int instance);
  void DrawShape(const Shape& shape, const nav::Pose& T_CA, TruthLayers& layers) const;
  void DrawTriangle(const std::array<Eigen::Vector3d, 3>& p_C, int instance,
                    TruthLayers& layers) const;

  [[nodiscard]] cv::Rect Reach(const std::array<Eigen::Vector3d, 3>& p_C) const;

  nav::CameraCalibration camera_;
  Frustum frustum_;
  Eigen::AlignedBox2d field_;            // of the normalized coordinates of all pixels
  std::vector<Eigen::Vector3d> rays_C_;  // row by row, z = 1
  std::vector<Shape> standing_;
  std::vector<std::vector<Shape>> acting_;  // actor by actor
  std::vector<std::vector<ActorKey>> paths_;
};

}  // namespace polnav::sim
