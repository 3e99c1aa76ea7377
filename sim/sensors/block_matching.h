// By how much did a small picture move since the one before?
//
// The firmware of an optical-flow sensor: blocks of 8 x 8 px are looked for within 4 px by the sum
// of absolute differences, as a PX4Flow does [Honegger2013]; then each is refined below a pixel by
// least squares [Lucas1981], where the PX4Flow compares half pixels only and so likes whole and
// half ones. Blocks without texture, or that agree neither with their match nor with the other
// blocks, are left out; the mean of the rest is the answer. A turn about the optical axis, or
// towards the ground, moves blocks on opposite sides oppositely and cancels. Fails where the
// picture moves by more than 4.5 px, or has no texture: too few blocks then agree.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace polnav::sim {

// x right, y down.
struct PictureShift {
  Eigen::Vector2d shift_px = Eigen::Vector2d::Zero();  // where what was at 0 is now
  int matched = 0;                                     // blocks that agree
  int blocks = 0;

  // As many as a PX4Flow wants.
  [[nodiscard]] bool valid() const { return matched >= 10; }
};

inline constexpr int kBlockSearch_px = 4;

// Both CV_8UC1, of one size, at least 32 px wide and high.
[[nodiscard]] PictureShift MatchBlocks(const cv::Mat& before, const cv::Mat& after);

}  // namespace polnav::sim
