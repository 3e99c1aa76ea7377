// Which points does the stereo pair see again?
//
// Images in, feature observations in rectified pixels out. Stateless about motion: two estimators
// can share one tracker, and what it returns does not depend on either.
//   corners.h      where there is something to follow
//   patch_flow.h   where it is in the next left image
//   references.h   where it is, seen from the picture in which it began
//   row_match.h    where it is in the right image
//   disparity_zero.h  where the pair sees infinity
// Needs texture; repeated patterns and moving objects are left for the estimator to reject.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "nav/api/measurements.h"
#include "nav/stereo/disparity_zero.h"
#include "nav/stereo/options.h"
#include "nav/stereo/patch_flow.h"
#include "nav/stereo/rectifier.h"
#include "nav/stereo/references.h"

namespace polnav::nav {

class StereoTracker {
 public:
  // describe: with descriptors, which loop closing needs and nothing else.
  StereoTracker(const TrackerOptions& options, const StereoCalibration& calibration,
                bool describe = false);

  // False: not to be tracked. One picture of the pair is missing or not of the calibration's size,
  // the stamp is not after the newest one's, or the left picture is the newest one's to the last
  // bit, which noise forbids: a frozen driver, not a standing vehicle. Two pictures in a row that
  // are black or white all over are alike too, and nothing is lost with them.
  [[nodiscard]] bool Accepts(const StereoImages& images) const;

  // Only of what it accepts. Pictures without contrast have no features.
  [[nodiscard]] StereoFeatures Track(const StereoImages& images);

  // Where the followed points are in the newest raw left image [px].
  [[nodiscard]] std::vector<cv::Point2f> points_px() const;

  [[nodiscard]] const RectifiedCamera& camera() const { return rectifier_.camera(); }

 private:
  [[nodiscard]] bool FitsCalibration(const cv::Mat& image) const;
  void FollowInTime(const Pyramid& pyramid);
  void Detect();
  [[nodiscard]] StereoFeatures MatchStereo(TimeNs stamp, const Pyramid& right);

  TrackerOptions options_;
  StereoRectifier rectifier_;
  cv::Size size_;
  bool describe_;
  StereoImages newest_;
  Pyramid pyramid_;  // of its left image
  DisparityZero zero_;
  std::vector<FollowedPoint> tracks_;
  std::uint64_t next_id_ = 0;
};

}  // namespace polnav::nav
