// Which points does the stereo pair see again?
//
// Images in, feature observations in rectified pixels out. Stateless about motion: two estimators
// can share one tracker, and what it returns does not depend on either.
// Needs texture; repeated patterns and moving objects are left for the estimator to reject.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "nav/api/measurements.h"
#include "nav/stereo/options.h"
#include "nav/stereo/rectifier.h"

namespace polnav::nav {

class StereoTracker {
 public:
  StereoTracker(const TrackerOptions& options, const StereoCalibration& calibration);

  [[nodiscard]] StereoFeatures Track(const StereoImages& images);

  // Where the followed points are in the newest raw left image [px].
  [[nodiscard]] std::vector<cv::Point2f> points_px() const;

  [[nodiscard]] const RectifiedCamera& camera() const { return rectifier_.camera(); }

 private:
  struct Tracked {
    std::uint64_t id = 0;
    cv::Point2f raw;         // in the current left image
    cv::Point2f flow;        // raw displacement since the previous image
    float disparity = 8.0F;  // raw u_left - u_right, a first guess where none was matched
    bool has_flow = false;
  };

  void FollowInTime(const std::vector<cv::Mat>& pyramid);
  void Detect(const cv::Mat& left);
  [[nodiscard]] StereoFeatures MatchStereo(TimeNs stamp, const std::vector<cv::Mat>& right);

  TrackerOptions options_;
  StereoRectifier rectifier_;
  std::vector<cv::Mat> pyramid_;  // of the newest left image
  std::vector<Tracked> tracked_;
  std::uint64_t next_id_ = 0;
};

}  // namespace polnav::nav
