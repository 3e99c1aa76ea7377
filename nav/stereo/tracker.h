// Which points does the stereo pair see again?
//
// Images in, feature observations in rectified pixels out. Stateless about motion: two estimators
// can share one tracker, and what it returns does not depend on either.
// Needs texture; repeated patterns and moving objects are left for the estimator to reject.
#pragma once

#include <cstdint>
#include <map>
#include <opencv2/core.hpp>
#include <vector>

#include "nav/api/measurements.h"
#include "nav/stereo/options.h"
#include "nav/stereo/rectifier.h"

namespace polnav::nav {

class StereoTracker {
 public:
  // describe: with descriptors, which loop closing needs and nothing else.
  StereoTracker(const TrackerOptions& options, const StereoCalibration& calibration,
                bool describe = false);

  // False: not to be tracked. One picture of the pair is missing, the stamp is not after the newest
  // one's, or the left picture is the newest one's to the last bit, which noise forbids: a frozen
  // driver, not a standing vehicle.
  [[nodiscard]] bool Accepts(const StereoImages& images) const;

  [[nodiscard]] StereoFeatures Track(const StereoImages& images);

  // Where the followed points are in the newest raw left image [px].
  [[nodiscard]] std::vector<cv::Point2f> points_px() const;

  [[nodiscard]] const RectifiedCamera& camera() const { return rectifier_.camera(); }

 private:
  struct Tracked {
    std::uint64_t id = 0;
    cv::Point2f raw;               // in the current left image
    cv::Point2f flow{0.0F, 0.0F};  // raw displacement since the previous image
    float disparity = 8.0F;        // raw u_left - u_right, a first guess where none was matched
    // The picture that the point is held against, so that errors do not add up frame by frame.
    std::uint64_t reference = 0;  // frame number
    cv::Point2f reference_raw;    // where it is there
    float reference_disparity = 0.0F;
  };

  using Pyramid = std::vector<cv::Mat>;

  void FollowInTime(const Pyramid& pyramid);
  void HoldAgainstReferences(const Pyramid& pyramid);
  void RenewReferences();
  [[nodiscard]] cv::Mat Describe(const cv::Mat& left) const;
  void Detect(const cv::Mat& left);
  [[nodiscard]] StereoFeatures MatchStereo(TimeNs stamp, const Pyramid& right);

  TrackerOptions options_;
  StereoRectifier rectifier_;
  bool describe_;
  StereoImages newest_;
  std::uint64_t frame_ = 0;                      // number of the newest one
  Pyramid pyramid_;                              // of its left image
  std::map<std::uint64_t, Pyramid> references_;  // left images by frame number
  std::vector<Tracked> tracked_;
  std::uint64_t next_id_ = 0;
};

}  // namespace polnav::nav
