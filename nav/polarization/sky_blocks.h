// What polarization is seen, and in which directions?
//
// The blocks of a picture that can be used, as arrays over blocks, for all compass methods alike.
//   L        level frame: z up, x as far forward as the body's x axis; B turned back by roll, pitch
//   x, y, z  N x 3, rows: a ray's axes and the ray in L; polarization counts from x towards y
// Tiles are patches of the picture about a correlation length wide: model errors are taken to be
// one number a tile, with neighbours alike.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "nav/api/calibration.h"
#include "nav/polarization/compass_options.h"
#include "nav/polarization/stokes_blocks.h"

namespace polnav::nav {

using Array3Xf = Eigen::Array<float, Eigen::Dynamic, 3>;

struct SkyBlocks {
  Array3Xf x;
  Array3Xf y;
  Array3Xf z;
  Eigen::ArrayXf q;          // Q / I
  Eigen::ArrayXf u;          // U / I
  Eigen::ArrayXf intensity;  // over full scale
  Eigen::ArrayXf variance;   // of q, and of u: pixels' noise and the channels' disagreement
  Eigen::Matrix3f R_LB = Eigen::Matrix3f::Identity();
  std::vector<int> index;  // of the block in the picture
  std::vector<int> tile;
  int in_view = 0;    // blocks in the part of the picture that counts
  int saturated = 0;  // of those, the ones left out for too much light
  int dark = 0;       // or too little

  [[nodiscard]] Eigen::Index size() const { return q.size(); }
};

// Roll about the body's x axis after pitch about its y axis: q_WB = heading * pitch * roll.
struct Tilt {
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
};

[[nodiscard]] inline Eigen::Quaterniond LevelFromBody(const Tilt& tilt) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(tilt.pitch_rad, Eigen::Vector3d::UnitY()) *
                            Eigen::AngleAxisd(tilt.roll_rad, Eigen::Vector3d::UnitX()));
}

// Patches of a picture: how alike their errors are.
struct Tiles {
  Eigen::MatrixXd likeness;  // correlation between tiles, by the angle between them
};

// Where the blocks of one camera look: prepared once.
class BlockView {
 public:
  BlockView(const CompassOptions& options, const PolarizationCameraCalibration& calibration,
            const BlockReader& reader);

  // The blocks to be used under this tilt.
  [[nodiscard]] SkyBlocks Select(const std::vector<StokesBlock>& blocks, const Tilt& tilt) const;

  [[nodiscard]] const Tiles& tiles() const { return tiles_; }

 private:
  [[nodiscard]] Eigen::MatrixXd Likeness(double correlation_rad) const;

  double min_up_;                        // sine of the lowest elevation that counts
  std::vector<Eigen::Matrix3f> axes_B_;  // columns x, y, ray
  std::vector<int> tile_;
  std::vector<bool> in_disc_;
  Tiles tiles_;
};

}  // namespace polnav::nav
