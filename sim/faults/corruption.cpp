#include "sim/faults/corruption.h"

#include <algorithm>
#include <cmath>

namespace polnav::sim {
namespace {

// Uniform from 0 to full scale.
int RandomValue(double full_scale, RandomStream::Sample& draw) {
  return static_cast<int>(draw.Uniform() * (full_scale + 1.0));
}

void Set(cv::Mat& image, int row, int column, int value) {
  if (image.type() == CV_16UC1) {
    image.at<std::uint16_t>(row, column) = static_cast<std::uint16_t>(value);
  } else {
    image.at<std::uint8_t>(row, column) = static_cast<std::uint8_t>(value);
  }
}

int Get(const cv::Mat& image, int row, int column) {
  return image.type() == CV_16UC1 ? image.at<std::uint16_t>(row, column)
                                  : image.at<std::uint8_t>(row, column);
}

void GarbleRows(double share, double full_scale, cv::Mat& image, RandomStream::Sample& draw) {
  const int band = std::clamp(static_cast<int>(std::lround(share * image.rows)), 0, image.rows);
  const int first = static_cast<int>(draw.Uniform() * (image.rows - band + 1));
  for (int row = first; row < first + band; ++row) {
    for (int column = 0; column < image.cols; ++column) {
      Set(image, row, column, RandomValue(full_scale, draw));
    }
  }
}

void LoseBlocks(double share, double full_scale, cv::Mat& image, RandomStream::Sample& draw) {
  constexpr int kBlock = 16;
  for (int row = 0; row < image.rows; row += kBlock) {
    for (int column = 0; column < image.cols; column += kBlock) {
      if (draw.Uniform() >= share) continue;
      const cv::Rect block(column, row, kBlock, kBlock);
      image(block & cv::Rect(0, 0, image.cols, image.rows)).setTo(std::floor(0.5 * full_scale));
    }
  }
}

void FlipBits(double share, double full_scale, cv::Mat& image, RandomStream::Sample& draw) {
  const int bits = static_cast<int>(std::lround(std::log2(full_scale + 1.0)));
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.cols; ++column) {
      if (draw.Uniform() >= share) continue;
      const int bit = static_cast<int>(draw.Uniform() * bits);
      Set(image, row, column, Get(image, row, column) ^ (1 << bit));
    }
  }
}

}  // namespace

cv::Mat Corrupted(const CorruptFault& fault, double full_scale, const cv::Mat& image,
                  RandomStream::Sample& draw) {
  if (fault.look == "missing") return {};
  cv::Mat left = image.clone();
  if (fault.look == "black") left.setTo(0);
  if (fault.look == "garbage_rows") GarbleRows(fault.share, full_scale, left, draw);
  if (fault.look == "lost_blocks") LoseBlocks(fault.share, full_scale, left, draw);
  if (fault.look == "bit_flips") FlipBits(fault.share, full_scale, left, draw);
  return left;
}

}  // namespace polnav::sim
