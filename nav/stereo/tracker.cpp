#include "nav/stereo/tracker.h"

#include <opencv2/features2d.hpp>
#include <stdexcept>
#include <utility>

#include "nav/stereo/corners.h"
#include "nav/stereo/row_match.h"

namespace polnav::nav {
namespace {

// ORB's binary descriptors [Rublee2011], upright, of the newest points: one row each, zeros where a
// point is too near the border.
cv::Mat Describe(const cv::Mat& left, const std::vector<FollowedPoint>& tracks) {
  std::vector<cv::KeyPoint> points;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    points.emplace_back(tracks[i].raw, 31.0F, 0.0F, 0.0F, 0, static_cast<int>(i));
  }
  cv::Mat described;
  cv::ORB::create(static_cast<int>(points.size()) + 1, 1.2F, 1)->compute(left, points, described);
  cv::Mat rows = cv::Mat::zeros(static_cast<int>(tracks.size()), 32, CV_8UC1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    described.row(static_cast<int>(i)).copyTo(rows.row(points[i].class_id));
  }
  return rows;
}

}  // namespace

StereoTracker::StereoTracker(const TrackerOptions& options, const StereoCalibration& calibration,
                             bool describe)
    : options_(options),
      rectifier_(calibration),
      size_(calibration.left.width_px, calibration.left.height_px),
      describe_(describe),
      zero_(options.zero, rectifier_.camera()) {}

bool StereoTracker::FitsCalibration(const cv::Mat& image) const {
  return image.type() == CV_8UC1 && image.size() == size_;
}

bool StereoTracker::Accepts(const StereoImages& images) const {
  if (!FitsCalibration(images.left) || !FitsCalibration(images.right)) return false;
  if (newest_.left.empty()) return true;
  return images.stamp > newest_.stamp && cv::norm(images.left, newest_.left, cv::NORM_INF) > 0.0;
}

StereoFeatures StereoTracker::Track(const StereoImages& images) {
  if (!FitsCalibration(images.left) || !FitsCalibration(images.right)) {
    throw std::logic_error("StereoTracker: needs two 8-bit grey images of the calibration's size");
  }
  newest_ = images;
  Pyramid left = BuildPyramid(images.left, options_, true);
  const Pyramid right = BuildPyramid(images.right, options_, false);
  if (!pyramid_.empty()) {
    FollowInTime(left);
    HoldToReferences(left, options_, tracks_);
  }
  pyramid_ = std::move(left);
  Detect();
  StereoFeatures features = MatchStereo(images.stamp, right);
  zero_.Add(features);
  for (FeatureObservation& f : features.features) {
    if (f.u_right_px) *f.u_right_px += zero_.zero_px();
  }
  if (describe_) features.descriptors = Describe(images.left, tracks_);
  RenewReferences(pyramid_, options_, tracks_);
  return features;
}

std::vector<cv::Point2f> StereoTracker::points_px() const {
  std::vector<cv::Point2f> points;
  for (const FollowedPoint& t : tracks_) points.push_back(t.raw);
  return points;
}

void StereoTracker::FollowInTime(const Pyramid& pyramid) {
  std::vector<cv::Point2f> from;
  std::vector<cv::Point2f> to;
  for (const FollowedPoint& t : tracks_) {
    from.push_back(t.raw);
    to.push_back(t.raw + t.flow);
  }
  const std::vector<bool> ok = FollowBothWays(pyramid_, pyramid, from, to, options_);
  std::vector<FollowedPoint> kept;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (!ok[i]) continue;
    FollowedPoint& t = tracks_[i];
    t.flow = to[i] - from[i];
    t.raw = to[i];
    kept.push_back(std::move(t));
  }
  tracks_ = std::move(kept);
}

void StereoTracker::Detect() {
  for (const cv::Point2f& p : FindCorners(pyramid_, points_px(), options_)) {
    tracks_.push_back({.id = next_id_++, .raw = p});
  }
}

StereoFeatures StereoTracker::MatchStereo(TimeNs stamp, const Pyramid& right) {
  const std::vector<cv::Point2f> rectified = rectifier_.RectifyLeft(points_px());
  const std::vector<cv::Mat> left_images = ImagesOf(pyramid_);
  RowMatcher matcher(options_, rectifier_, left_images, right);
  StereoFeatures features{.stamp = stamp};
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    FollowedPoint& track = tracks_[i];
    const cv::Point2f l = rectified[i];
    FeatureObservation observation{.id = track.id, .uv_left_px = {l.x, l.y}};
    track.disparity = matcher.Match({track.raw, l, track.disparity});
    if (track.disparity) observation.u_right_px = l.x - *track.disparity;
    features.features.push_back(observation);
  }
  return features;
}

}  // namespace polnav::nav
