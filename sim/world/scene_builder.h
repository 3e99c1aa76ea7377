// How is a scene put together from walls, boxes, poles and blobs?
//
// Triangles go into one mesh per texture and square of ground, so that the renderer can leave out
// whole squares. Every function takes metres in W and draws the side that its normal points to.
#pragma once

#include <Eigen/Core>
#include <array>
#include <compare>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "sim/random.h"
#include "sim/world/scene.h"

namespace polnav::sim {

// A rectangle: its lower left corner as seen from outside, and its two edges.
struct Wall {
  Eigen::Vector3d corner_m;
  Eigen::Vector3d right_m;
  Eigen::Vector3d up_m;
  int columns = 1;  // of quads, for shade to vary over
  int rows = 1;
};

// uv of the upper left corner, and its size; v runs down, like an image's rows.
struct UvRect {
  double u = 0.0;
  double v = 0.0;
  double width = 1.0;
  double height = 1.0;
};

// A box standing on a point: yaw_rad turns its length away from east, counter-clockwise.
struct Box {
  Eigen::Vector3d foot_m;
  double yaw_rad = 0.0;
  double length_m = 1.0;
  double width_m = 1.0;
  double height_m = 1.0;
  double top_scale = 1.0;  // of the upper face: below 1 the sides lean inwards
};

// A cylinder or a cone between two points; its upper end is open or flat.
struct Pole {
  Eigen::Vector3d foot_m;
  Eigen::Vector3d top_m;
  double foot_radius_m = 0.1;
  double top_radius_m = 0.1;
  int sides = 6;
  bool capped = false;
};

class SceneBuilder {
 public:
  // cell_m: side of a square of ground; infinity keeps everything of a texture together.
  // draws: false leaves every texture a single pixel, for whom only shapes matter.
  explicit SceneBuilder(double cell_m = 32.0, bool draws = true) : cell_m_(cell_m), draws_(draws) {}

  // Linear reflectance, sides powers of two. detail: see Scene.
  int AddTexture(const std::function<cv::Mat()>& draw, double detail = 1.0);
  // Kept even where nothing is drawn.
  int AddTexture(const cv::Mat& reflectance, double detail);

  [[nodiscard]] bool draws() const { return draws_; }

  // What is added from now on is a thing of this kind.
  void SetLabel(Label label) { label_ = label; }

  // While on, what is added is left out of pictures from more than 45 m away.
  void SetDetail(bool is_detail) { is_detail_ = is_detail; }

  // Share of the sky behind it that a surface added from now on hides; below 1 for foliage alone.
  void SetCover(double cover) { cover_ = static_cast<float>(cover); }

  // The mesh of this texture that holds what stands at this place.
  Mesh& MeshAt(const Eigen::Vector3d& p_m, int texture);

  // `shade` scales the texture; shade_spread varies it from vertex to vertex.
  void AddWall(const Wall& wall, int texture, const UvRect& uv, double shade, double shade_spread,
               RandomStream::Sample& random);
  // Sides and top; uv_per_m: repeats of the texture a metre.
  void AddBox(const Box& box, int texture, double uv_per_m, double shade);
  void AddPole(const Pole& pole, int texture, double uv_per_m, double shade);
  // A lumpy ellipsoid, the crown of a tree or a bush.
  void AddBlob(const Eigen::Vector3d& center_m, const Eigen::Vector3d& radii_m, int texture,
               double shade, RandomStream::Sample& random);

  // What was made in a frame A of its own, its textures by this builder.
  void AddModel(const std::vector<Mesh>& meshes_A, const nav::Pose& T_WA);

  [[nodiscard]] Scene Take() { return std::move(scene_); }

 private:
  struct Cell {
    int column, row, texture;
    bool is_detail;
    Label label;
    float cover;
    auto operator<=>(const Cell&) const = default;
  };
  void AddFlatQuad(Mesh& mesh, const std::array<Eigen::Vector3d, 4>& corners_ccw, double uv_per_m,
                   double shade);

  void CapPole(Mesh& mesh, const Pole& pole, std::uint32_t first, double uv_per_m, double shade);

  double cell_m_;
  bool draws_;
  Scene scene_;
  bool is_detail_ = false;
  Label label_ = Label::kGround;
  float cover_ = 1.0F;
  std::map<Cell, std::size_t> mesh_of_cell_;
};

}  // namespace polnav::sim
