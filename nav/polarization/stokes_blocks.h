// What light does each block of a raw mosaic hold?
//
// Pixels are summed by channel over square blocks before anything else is done: that is where the
// time goes, and where noise becomes small. The four pixels of a cell look at slightly different
// places, so that a slope of the light reads as polarization: each channel's mean is moved to the
// block's middle by the slope that its own means have over the neighbouring blocks. A block's
// Stokes parameters are the least squares of its four means through the calibrated analyzers
// (sky/mosaic.h), about the axes of the block's ray (nav/api/lens.h). Their noise is the shot and
// read noise of the calibration.
// Cells with a pixel near full scale are left out, cell by cell.
// Where it fails: a block across a sharp edge mixes what lies on both sides, and its four channels
// see the edge at different places: `mismatch` tells.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "nav/api/calibration.h"

namespace polnav::nav {

struct ChannelBlock {
  Eigen::Vector4f mean = Eigen::Vector4f::Zero();  // over full scale, at the block's middle
  float usable = 0.0F;  // share of its cells below saturation; 0: nothing is known of the block
};

struct StokesBlock {
  float intensity = 0.0F;  // mean over full scale; 0: nothing is known of the block
  float q = 0.0F;          // Q / I
  float u = 0.0F;          // U / I
  float variance = 0.0F;   // of q, and of u: noise of the pixels
  float mismatch = 0.0F;   // what the two opponent pairs disagree by, over the intensity
  float usable = 0.0F;     // share of its cells
};

class BlockReader {
 public:
  // block_px: even. saturation: pixels above, over full scale, do not count.
  // Throws std::invalid_argument when not one block fits.
  BlockReader(const PolarizationCameraCalibration& calibration, int block_px, double saturation);

  // Throws std::invalid_argument when the mosaic is not of the calibration's size and depth.
  void ReadChannels(const cv::Mat& mosaic, std::vector<ChannelBlock>& channels) const;

  void Invert(const std::vector<ChannelBlock>& channels, std::vector<StokesBlock>& blocks) const;

  [[nodiscard]] std::vector<StokesBlock> Read(const cv::Mat& mosaic) const;

  [[nodiscard]] int cols() const { return cols_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] int block_px() const { return block_px_; }
  [[nodiscard]] Eigen::Vector2d Center(int col, int row) const {
    const double half = 0.5 * (block_px_ - 1);
    return {col * block_px_ + half, row * block_px_ + half};
  }

 private:
  template <typename Pixel, typename Sum>
  void SumRows(const cv::Mat& mosaic, std::vector<ChannelBlock>& channels) const;
  void MoveToMiddle(std::vector<ChannelBlock>& channels) const;
  [[nodiscard]] StokesBlock Invert(const ChannelBlock& channels) const;

  PolarizationCameraCalibration calibration_;
  int block_px_;
  int cols_;
  int rows_;
  float top_;
  float limit_;  // grey level
  Eigen::Matrix<float, 3, 4> inverse_;
  Eigen::Vector4f opponents_;  // adds one pair and subtracts the other
  Eigen::Vector4f dark_;
};

// An even size that cuts the picture into some 2000 blocks, at least 4 pixels wide.
[[nodiscard]] int BlockSizeFor(int width_px, int height_px);

}  // namespace polnav::nav
