// Where is a patch of one image in another, and how has it been stretched?
//
// Least squares of grey values over where the middle went, a 2x2 stretch, gain and offset
// [Baker2004, inverse compositional]. Ground that comes nearer is stretched across its patch, and
// along the rows otherwise than along the columns: with a shift alone the place would be where the
// contrast went, which is not where the middle did.
//   image(at + stretch x) = gain patch(x) + offset
// Fails where the surface is not flat across the patch: outlines, leaves.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>

#include "nav/stereo/patch.h"

namespace polnav::nav {

struct PatchPlace {
  cv::Point2f at;  // of the patch's middle [px]
  cv::Matx22f stretch = cv::Matx22f::eye();
};

class PatchAligner {
 public:
  // half: the patch has 2 half + 1 pixels a side. least_correlation: of what is to be trusted.
  PatchAligner(int half, double least_correlation)
      : half_(half), least_correlation_(static_cast<float>(least_correlation)) {}

  // From a guess that is right to a pixel or two. Nothing where the patch has no contrast, leaves
  // the image, or looks otherwise. Full-size 8-bit grey images.
  [[nodiscard]] std::optional<PatchPlace> Align(const cv::Mat& from, const cv::Point2f& middle,
                                                const cv::Mat& to, const PatchPlace& guess);

 private:
  using Vector8f = Eigen::Matrix<float, 8, 1>;
  using Matrix8f = Eigen::Matrix<float, 8, 8>;

  [[nodiscard]] bool Prepare(const cv::Mat& from, const cv::Point2f& middle);

  int half_;
  float least_correlation_;
  // Scratch, kept to save allocations.
  Patch wide_;
  Patch template_;
  Patch seen_;
  Eigen::Matrix<float, 8, Eigen::Dynamic> rows_;  // of the template, by the unknowns
  Matrix8f information_ = Matrix8f::Zero();
};

}  // namespace polnav::nav
