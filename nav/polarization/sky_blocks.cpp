#include "nav/polarization/sky_blocks.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace polnav::nav {
namespace {

constexpr int kTilesAcross = 8;
constexpr int kTilesDown = 6;
constexpr float kWholeEnough = 0.75F;  // of a block's cells; fewer sit to one side of it

int TileOf(int col, int row, const BlockReader& reader) {
  return kTilesAcross * (row * kTilesDown / reader.rows()) + col * kTilesAcross / reader.cols();
}

}  // namespace

BlockView::BlockView(const CompassOptions& options,
                     const PolarizationCameraCalibration& calibration, const BlockReader& reader)
    : min_up_(std::sin(DegToRad(options.min_elevation_deg))) {
  const Lens& lens = calibration.lens;
  for (int row = 0; row < reader.rows(); ++row) {
    for (int col = 0; col < reader.cols(); ++col) {
      const Eigen::Vector2d middle = reader.Center(col, row);
      const PixelAxes axes = AxesOfPixel(lens, middle);
      Eigen::Matrix3d columns;
      columns << calibration.T_BS.q * axes.x_S, calibration.T_BS.q * axes.y_S,
          calibration.T_BS.q * axes.ray_S;
      axes_B_.push_back(columns.cast<float>());
      tile_.push_back(TileOf(col, row, reader));
      in_disc_.push_back(options.radius_px <= 0.0 ||
                         (middle - lens.center_px).norm() <= options.radius_px);
    }
  }
  tiles_.likeness = Likeness(DegToRad(options.correlation_deg));
}

Eigen::MatrixXd BlockView::Likeness(double correlation_rad) const {
  constexpr int kTiles = kTilesAcross * kTilesDown;
  Eigen::Matrix3Xd middle = Eigen::Matrix3Xd::Zero(3, kTiles);
  for (std::size_t i = 0; i < tile_.size(); ++i) {
    middle.col(tile_[i]) += axes_B_[i].col(2).cast<double>();
  }
  Eigen::MatrixXd likeness = Eigen::MatrixXd::Identity(kTiles, kTiles);
  for (int a = 0; a < kTiles; ++a) {
    for (int b = 0; b < a; ++b) {
      const Eigen::Vector3d one = middle.col(a);
      const Eigen::Vector3d other = middle.col(b);
      const double apart = std::atan2(one.cross(other).norm(), one.dot(other)) / correlation_rad;
      likeness(a, b) = likeness(b, a) = std::exp(-apart);
    }
  }
  return likeness;
}

SkyBlocks BlockView::Select(const std::vector<StokesBlock>& blocks, const Tilt& tilt) const {
  SkyBlocks sky;
  const Eigen::Matrix3f R_LB = LevelFromBody(tilt).toRotationMatrix().cast<float>();
  sky.R_LB = R_LB;
  const auto min_up = static_cast<float>(min_up_);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (!in_disc_[i] || R_LB.row(2).dot(axes_B_[i].col(2)) < min_up) continue;
    ++sky.in_view;
    if (blocks[i].usable < kWholeEnough) {
      ++sky.saturated;
      continue;
    }
    if (blocks[i].intensity <= 0.0F) {
      ++sky.dark;
      continue;
    }
    sky.index.push_back(static_cast<int>(i));
    sky.tile.push_back(tile_[i]);
  }
  const auto size = static_cast<Eigen::Index>(sky.index.size());
  for (Array3Xf* const axis : {&sky.x, &sky.y, &sky.z}) axis->resize(size, 3);
  for (Eigen::ArrayXf* const value : {&sky.q, &sky.u, &sky.intensity, &sky.variance})
    value->resize(size);
  for (Eigen::Index k = 0; k < size; ++k) {
    const auto i = static_cast<std::size_t>(sky.index[static_cast<std::size_t>(k)]);
    const Eigen::Matrix3f axes_L = R_LB * axes_B_[i];
    sky.x.row(k) = axes_L.col(0).transpose().array();
    sky.y.row(k) = axes_L.col(1).transpose().array();
    sky.z.row(k) = axes_L.col(2).transpose().array();
    sky.q[k] = blocks[i].q;
    sky.u[k] = blocks[i].u;
    sky.intensity[k] = blocks[i].intensity;
    // Pairs that disagree by more than noise see different light: an edge.
    sky.variance[k] = blocks[i].variance + blocks[i].mismatch * blocks[i].mismatch;
  }
  return sky;
}

}  // namespace polnav::nav
