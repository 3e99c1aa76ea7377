// Where is a patch of one image in another, and how has it been stretched?
//
// Least squares of grey values over where the middle went, a 2x2 stretch, gain and offset
// [Baker2004, inverse compositional]. Ground that comes nearer is stretched across its patch, and
// along the rows otherwise than along the columns: with a shift alone the place would be where the
// contrast went, which is not where the middle did.
//   image(at + stretch x) = gain patch(x) + offset
// Fails where the surface is not flat across the patch: outlines, leaves.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>

#include "nav/stereo/patch.h"

namespace polnav::nav {

// What is looked for, and all that can be reckoned before it is known where. Unknowns: place (2),
// stretch row by row (4), gain, offset.
struct PatchTemplate {
  int half = 0;                                  // 2 half + 1 pixels a side
  Eigen::Matrix<float, 8, Eigen::Dynamic> rows;  // by the unknowns, a column a pixel
  Eigen::Matrix<float, 8, 1> by_gain;            // rows times the grey values less their mean
  Eigen::Matrix<float, 8, 1> by_offset;          // rows times ones
  Eigen::LDLT<Eigen::Matrix<float, 8, 8>> information;
};

struct PatchPlace {
  cv::Point2f at;  // of the patch's middle [px]
  cv::Matx22f stretch = cv::Matx22f::eye();
};

// Around a point of a full-size 8-bit grey image. Nothing where the patch leaves the image or has
// no contrast, whichever way it is looked at.
[[nodiscard]] std::optional<PatchTemplate> CutTemplate(const cv::Mat& image,
                                                       const cv::Point2f& middle, int half);

// From a guess that is right to a pixel or two. Nothing where the patch leaves the image or
// correlates less than asked with what is there.
[[nodiscard]] std::optional<PatchPlace> AlignTemplate(const PatchTemplate& patch,
                                                      const cv::Mat& image, const PatchPlace& guess,
                                                      float least_correlation);

}  // namespace polnav::nav
