// Where along its row does the right camera see a point of the left image?
//
// The calibration fixes the curve on which the match has to lie, one number is left: the disparity
// d in rectified pixels. Images stay raw; the curve is followed through the right lens.
//   coarse   correlation of patches along the curve, from a quarter of the size to full size
//   fine     least squares of grey values over d, the slope of d across the patch, gain and offset
//   back     the match, looked for in the left image, has to lead back
// The slope matters: the patch's best shift as a whole is the disparity of wherever its contrast
// is, which on the ground is not that of its centre.
// Needs contrast along the row; repeated patterns may deceive it.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "nav/stereo/options.h"
#include "nav/stereo/patch.h"
#include "nav/stereo/rectifier.h"

namespace polnav::nav {

struct RowQuery {
  cv::Point2f left_raw;
  cv::Point2f left_rectified;
  std::optional<float>
      expected_px;  // disparity, to some pixels; nothing: the whole row is searched
};

class RowMatcher {
 public:
  // Pyramids of full, half, quarter size ... of 8-bit grey; they and the rectifier must outlive it.
  RowMatcher(const TrackerOptions& options, const StereoRectifier& rectifier,
             const std::vector<cv::Mat>& left, const std::vector<cv::Mat>& right);

  // The disparity [px], nothing where no match is to be trusted.
  [[nodiscard]] std::optional<float> Match(const RowQuery& query);

 private:
  struct Curve {
    cv::Point2f at;     // in the raw right image
    cv::Point2f along;  // its change per pixel of disparity
  };
  [[nodiscard]] Curve CurveAt(const RowQuery& query, float disparity_px) const;
  [[nodiscard]] std::optional<float> Search(const RowQuery& query, int level, int half, float first,
                                            float last, float step);
  [[nodiscard]] std::optional<float> Coarse(const RowQuery& query);
  [[nodiscard]] std::optional<float> Refine(const RowQuery& query, float disparity_px);
  void FillRows(const cv::Point2f& along);
  [[nodiscard]] bool LeadsBack(const RowQuery& query, float disparity_px);

  const TrackerOptions& options_;
  const StereoRectifier& rectifier_;
  const std::vector<cv::Mat>& left_;
  const std::vector<cv::Mat>& right_;
  int half_;
  // Scratch, kept to save allocations.
  Patch template_;
  Patch candidate_;
  Eigen::Matrix<float, 5, Eigen::Dynamic> rows_;  // of the fine search, a column a pixel
};

}  // namespace polnav::nav
