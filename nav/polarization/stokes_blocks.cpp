#include "nav/polarization/stokes_blocks.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "sky/mosaic.h"

namespace polnav::nav {
namespace {

constexpr double kBlocks = 2000.0;

struct CellSums {
  Eigen::Vector4f sums = Eigen::Vector4f::Zero();
  int cells = 0;
};

// Cell by cell, for the few blocks with a pixel near full scale.
template <typename Pixel>
CellSums SumUnsaturated(const cv::Mat& mosaic, int left, int top, int size, float limit) {
  CellSums result;
  for (int row = top; row < top + size; row += 2) {
    const Pixel* const upper = mosaic.ptr<Pixel>(row);
    const Pixel* const lower = mosaic.ptr<Pixel>(row + 1);
    for (int col = left; col < left + size; col += 2) {
      const Pixel peak = std::max({upper[col], upper[col + 1], lower[col], lower[col + 1]});
      if (static_cast<float>(peak) > limit) continue;
      result.sums += Eigen::Vector4f(upper[col], upper[col + 1], lower[col], lower[col + 1]);
      ++result.cells;
    }
  }
  return result;
}

// Of the mean from `before` over `here` to `after`, in a block's width; 0 when nobody knows.
Eigen::Vector4f Slope(const ChannelBlock* before, const ChannelBlock& here,
                      const ChannelBlock* after) {
  const bool has_before = before != nullptr && before->usable > 0.0F;
  const bool has_after = after != nullptr && after->usable > 0.0F;
  if (has_before && has_after) return 0.5F * (after->mean - before->mean);
  if (has_before) return here.mean - before->mean;
  if (has_after) return after->mean - here.mean;
  return Eigen::Vector4f::Zero();
}

}  // namespace

int BlockSizeFor(int width_px, int height_px) {
  const double side = std::sqrt(static_cast<double>(width_px) * height_px / kBlocks);
  return std::max(4, 2 * static_cast<int>(std::lround(0.5 * side)));
}

BlockReader::BlockReader(const PolarizationCameraCalibration& calibration, int block_px,
                         double saturation)
    : calibration_(calibration),
      block_px_(block_px),
      cols_(calibration.width_px / std::max(block_px, 1)),
      rows_(calibration.height_px / std::max(block_px, 1)),
      top_(static_cast<float>(std::ldexp(1.0, calibration.bits) - 1.0)),
      limit_(static_cast<float>(saturation) * top_) {
  if (block_px < 2 || block_px % 2 != 0) throw std::logic_error("blocks are of whole cells");
  if (cols_ < 1 || rows_ < 1) {
    throw std::invalid_argument(fmt::format("an image of {} x {} pixels is too small",
                                            calibration.width_px, calibration.height_px));
  }
  const Eigen::Matrix<double, 4, 3> analyzers =
      sky::AnalyzerMatrix(calibration.polarizer_rad, calibration.gain);
  inverse_ = ((analyzers.transpose() * analyzers).inverse() * analyzers.transpose()).cast<float>();
  dark_ = Eigen::Map<const Eigen::Vector4d>(calibration.offset.data()).cast<float>();
  for (int k = 0; k < 4; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double sign = std::cos(4.0 * calibration.polarizer_rad[i]) > 0.0 ? 1.0 : -1.0;
    opponents_[k] = static_cast<float>(sign / calibration.gain[i]);
  }
}

StokesBlock BlockReader::Invert(const ChannelBlock& channels) const {
  StokesBlock block;
  block.usable = channels.usable;
  if (channels.usable <= 0.0F) return block;
  const Eigen::Vector4f light = channels.mean - dark_;
  const Eigen::Vector3f stokes = inverse_ * light;
  if (!(stokes[0] > 0.0F)) return block;
  const double read = calibration_.read_noise_e / calibration_.full_well_e;
  const double quantum = 1.0 / top_;
  const double pixel_variance =
      stokes[0] / calibration_.full_well_e + read * read + quantum * quantum / 12.0;
  const double cells = channels.usable * 0.25 * block_px_ * block_px_;
  block.intensity = stokes[0];
  block.q = stokes[1] / stokes[0];
  block.u = stokes[2] / stokes[0];
  // Q and U are half differences of opposite channels, each a mean over the cells.
  block.variance = static_cast<float>(pixel_variance / (2.0 * cells * stokes[0] * stokes[0]));
  // Opposite channels sum to the same light [Zeng2020, eqs 4-6].
  block.mismatch = opponents_.dot(light) / (2.0F * stokes[0]);
  return block;
}

template <typename Pixel, typename Sum>
void BlockReader::SumRows(const cv::Mat& mosaic, std::vector<ChannelBlock>& channels) const {
  const auto width = static_cast<std::size_t>(cols_ * block_px_);
  const float all_cells = 0.25F * static_cast<float>(block_px_ * block_px_);
  // Plain arrays and plain loops over columns: the compiler makes vectors of them.
  std::vector<Sum> even(width);
  std::vector<Sum> odd(width);
  std::vector<Pixel> brightest(width);
  for (int block_row = 0; block_row < rows_; ++block_row) {
    std::fill(even.begin(), even.end(), Sum{0});
    std::fill(odd.begin(), odd.end(), Sum{0});
    std::fill(brightest.begin(), brightest.end(), Pixel{0});
    for (int k = 0; k < block_px_; k += 2) {
      const Pixel* const upper = mosaic.ptr<Pixel>(block_row * block_px_ + k);
      const Pixel* const lower = mosaic.ptr<Pixel>(block_row * block_px_ + k + 1);
      for (std::size_t col = 0; col < width; ++col) {
        even[col] = static_cast<Sum>(even[col] + upper[col]);
        odd[col] = static_cast<Sum>(odd[col] + lower[col]);
        brightest[col] = std::max(brightest[col], std::max(upper[col], lower[col]));
      }
    }
    for (int block_col = 0; block_col < cols_; ++block_col) {
      const auto left = static_cast<std::size_t>(block_col * block_px_);
      CellSums all{.cells = block_px_ * block_px_ / 4};
      int peak = 0;
      for (std::size_t col = left; col < left + static_cast<std::size_t>(block_px_); col += 2) {
        all.sums += Eigen::Vector4f(even[col], even[col + 1], odd[col], odd[col + 1]);
        peak = std::max<int>(peak, std::max(brightest[col], brightest[col + 1]));
      }
      if (static_cast<float>(peak) > limit_) {
        all = SumUnsaturated<Pixel>(mosaic, static_cast<int>(left), block_row * block_px_,
                                    block_px_, limit_);
      }
      const auto cells = static_cast<float>(all.cells);
      ChannelBlock& block = channels[static_cast<std::size_t>(block_row * cols_ + block_col)];
      block.usable = cells / all_cells;
      block.mean = all.sums / (std::max(cells, 1.0F) * top_);
    }
  }
}

// A pixel of a cell sits half a pixel from the cell's middle.
void BlockReader::MoveToMiddle(std::vector<ChannelBlock>& channels) const {
  const std::vector<ChannelBlock> raw = channels;
  const float share = 0.5F / static_cast<float>(block_px_);
  const Eigen::Vector4f right = share * Eigen::Vector4f(-1.0F, 1.0F, -1.0F, 1.0F);
  const Eigen::Vector4f down = share * Eigen::Vector4f(-1.0F, -1.0F, 1.0F, 1.0F);
  for (int row = 0; row < rows_; ++row) {
    for (int col = 0; col < cols_; ++col) {
      const ChannelBlock* const here = &raw[static_cast<std::size_t>(row * cols_ + col)];
      if (here->usable <= 0.0F) continue;
      const Eigen::Vector4f across =
          Slope(col > 0 ? here - 1 : nullptr, *here, col + 1 < cols_ ? here + 1 : nullptr);
      const Eigen::Vector4f along =
          Slope(row > 0 ? here - cols_ : nullptr, *here, row + 1 < rows_ ? here + cols_ : nullptr);
      channels[static_cast<std::size_t>(row * cols_ + col)].mean -=
          right.cwiseProduct(across) + down.cwiseProduct(along);
    }
  }
}

void BlockReader::ReadChannels(const cv::Mat& mosaic, std::vector<ChannelBlock>& channels) const {
  const int type = calibration_.bits > 8 ? CV_16UC1 : CV_8UC1;
  if (mosaic.cols != calibration_.width_px || mosaic.rows != calibration_.height_px ||
      mosaic.type() != type) {
    throw std::invalid_argument(fmt::format(
        "the mosaic has {} x {} pixels of {} channels of {} bytes; expected are {} x {} of 1 of {}",
        mosaic.cols, mosaic.rows, mosaic.channels(), mosaic.elemSize1(), calibration_.width_px,
        calibration_.height_px, calibration_.bits > 8 ? 2 : 1));
  }
  channels.resize(static_cast<std::size_t>(cols_) * static_cast<std::size_t>(rows_));
  // Half a block's rows of bytes fit 16 bits up to blocks of 514 pixels.
  if (type == CV_16UC1) {
    SumRows<std::uint16_t, std::uint32_t>(mosaic, channels);
  } else if (block_px_ <= 512) {
    SumRows<std::uint8_t, std::uint16_t>(mosaic, channels);
  } else {
    SumRows<std::uint8_t, std::uint32_t>(mosaic, channels);
  }
  MoveToMiddle(channels);
}

void BlockReader::Invert(const std::vector<ChannelBlock>& channels,
                         std::vector<StokesBlock>& blocks) const {
  blocks.resize(channels.size());
  for (std::size_t i = 0; i < channels.size(); ++i) blocks[i] = Invert(channels[i]);
}

std::vector<StokesBlock> BlockReader::Read(const cv::Mat& mosaic) const {
  std::vector<ChannelBlock> channels;
  std::vector<StokesBlock> blocks;
  ReadChannels(mosaic, channels);
  Invert(channels, blocks);
  return blocks;
}

}  // namespace polnav::nav
