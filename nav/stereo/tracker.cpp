#include "nav/stereo/tracker.h"

#include <algorithm>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <set>
#include <stdexcept>

namespace polnav::nav {
namespace {

// Stopping at a step of 0.01 px may leave that much of the first guess in a position, and always to
// the same side.
const cv::TermCriteria kUntil(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 30, 0.001);

constexpr std::uint64_t kNoReference = ~std::uint64_t{0};
// Pictures kept to hold tracks against, 2.3 MB each at VGA; driving needs about thirty.
constexpr std::size_t kMaxReferences = 48;

std::vector<cv::Mat> BuildPyramid(const cv::Mat& image, const TrackerOptions& options) {
  std::vector<cv::Mat> pyramid;
  cv::Mat smooth = image;
  if (options.smoothing_px > 0.0) {
    cv::GaussianBlur(image, smooth, {5, 5}, options.smoothing_px);
  }
  cv::buildOpticalFlowPyramid(smooth, pyramid, {options.window_px, options.window_px},
                              options.pyramid_levels);
  return pyramid;
}

// Follows points from one image to another and back; a point that does not return to within the
// threshold is not to be trusted. `to` holds the first guess on entry.
std::vector<bool> FollowBothWays(const std::vector<cv::Mat>& from_pyramid,
                                 const std::vector<cv::Mat>& to_pyramid,
                                 const std::vector<cv::Point2f>& from, std::vector<cv::Point2f>& to,
                                 const TrackerOptions& options) {
  std::vector<bool> ok(from.size(), false);
  if (from.empty()) return ok;
  const cv::Size window(options.window_px, options.window_px);
  std::vector<std::uint8_t> status;
  std::vector<std::uint8_t> status_back;
  cv::calcOpticalFlowPyrLK(from_pyramid, to_pyramid, from, to, status, cv::noArray(), window,
                           options.pyramid_levels, kUntil, cv::OPTFLOW_USE_INITIAL_FLOW);
  // Starting the way back from the origin would hide a patch that locked onto something else;
  // one pyramid level suffices to see whether it comes back.
  std::vector<cv::Point2f> back = from;
  cv::calcOpticalFlowPyrLK(to_pyramid, from_pyramid, to, back, status_back, cv::noArray(), window,
                           1, kUntil, cv::OPTFLOW_USE_INITIAL_FLOW);
  const cv::Size size = to_pyramid[0].size();
  const auto limit = static_cast<float>(options.forward_backward_px);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const cv::Point2f d = back[i] - from[i];
    const bool inside =
        to[i].x >= 1 && to[i].y >= 1 && to[i].x < size.width - 2 && to[i].y < size.height - 2;
    ok[i] = status[i] != 0 && status_back[i] != 0 && inside && d.dot(d) < limit * limit;
  }
  return ok;
}

}  // namespace

StereoTracker::StereoTracker(const TrackerOptions& options, const StereoCalibration& calibration,
                             bool describe)
    : options_(options), rectifier_(calibration), describe_(describe) {}

bool StereoTracker::Accepts(const StereoImages& images) const {
  if (images.left.empty() || images.right.empty()) return false;
  if (newest_.left.empty()) return true;
  return images.stamp > newest_.stamp && cv::norm(images.left, newest_.left, cv::NORM_INF) > 0.0;
}

StereoFeatures StereoTracker::Track(const StereoImages& images) {
  if (images.left.type() != CV_8UC1 || images.left.size() != images.right.size()) {
    throw std::logic_error("StereoTracker: needs two 8-bit grey images of one size");
  }
  newest_ = images;
  const Pyramid left = BuildPyramid(images.left, options_);
  const Pyramid right = BuildPyramid(images.right, options_);
  if (!pyramid_.empty()) {
    FollowInTime(left);
    HoldAgainstReferences(left);
    ++frame_;
  }
  pyramid_ = left;
  Detect(images.left);
  StereoFeatures features = MatchStereo(images.stamp, right);
  if (describe_) features.descriptors = Describe(images.left);
  RenewReferences();
  return features;
}

std::vector<cv::Point2f> StereoTracker::points_px() const {
  std::vector<cv::Point2f> points;
  for (const Tracked& t : tracked_) points.push_back(t.raw);
  return points;
}

void StereoTracker::FollowInTime(const Pyramid& pyramid) {
  std::vector<cv::Point2f> from;
  std::vector<cv::Point2f> to;
  for (const Tracked& t : tracked_) {
    from.push_back(t.raw);
    to.push_back(t.raw + t.flow);
  }
  const std::vector<bool> ok = FollowBothWays(pyramid_, pyramid, from, to, options_);
  std::vector<Tracked> kept;
  for (std::size_t i = 0; i < tracked_.size(); ++i) {
    if (!ok[i]) continue;
    Tracked t = tracked_[i];
    t.flow = to[i] - from[i];
    t.raw = to[i];
    kept.push_back(t);
  }
  tracked_ = std::move(kept);
}

// A track that is followed from frame to frame wanders off its point a little each time. Held
// against the picture where it began it does not, as long as it still looks the same.
void StereoTracker::HoldAgainstReferences(const Pyramid& pyramid) {
  std::map<std::uint64_t, std::vector<Tracked*>> by_reference;
  for (Tracked& t : tracked_) {
    if (t.reference != kNoReference) by_reference[t.reference].push_back(&t);
  }
  const auto limit = static_cast<float>(options_.reference_px);
  for (const auto& [reference, tracks] : by_reference) {
    std::vector<cv::Point2f> from;
    std::vector<cv::Point2f> to;
    for (const Tracked* t : tracks) {
      from.push_back(t->reference_raw);
      to.push_back(t->raw);
    }
    std::vector<std::uint8_t> status;
    cv::calcOpticalFlowPyrLK(references_.at(reference), pyramid, from, to, status, cv::noArray(),
                             {options_.window_px, options_.window_px}, 0, kUntil,
                             cv::OPTFLOW_USE_INITIAL_FLOW);
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      const cv::Point2f d = to[i] - tracks[i]->raw;
      if (status[i] != 0 && d.dot(d) < limit * limit) {
        tracks[i]->raw = to[i];
      } else {
        tracks[i]->reference = kNoReference;
      }
    }
  }
}

// ORB's binary descriptors [Rublee2011], upright, of the newest points: one row each, zeros where a
// point is too near the border.
cv::Mat StereoTracker::Describe(const cv::Mat& left) const {
  std::vector<cv::KeyPoint> points;
  for (std::size_t i = 0; i < tracked_.size(); ++i) {
    points.emplace_back(tracked_[i].raw, 31.0F, 0.0F, 0.0F, 0, static_cast<int>(i));
  }
  cv::Mat described;
  cv::ORB::create(static_cast<int>(points.size()) + 1, 1.2F, 1)->compute(left, points, described);
  cv::Mat rows = cv::Mat::zeros(static_cast<int>(tracked_.size()), 32, CV_8UC1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    described.row(static_cast<int>(i)).copyTo(rows.row(points[i].class_id));
  }
  return rows;
}

// Begins anew where a reference is missing or shows the point from too near or too far.
void StereoTracker::RenewReferences() {
  references_[frame_] = pyramid_;
  const auto renew = [this](Tracked& t) {
    t.reference = frame_;
    t.reference_raw = t.raw;
    t.reference_disparity = t.disparity;
  };
  std::set<std::uint64_t> needed;
  for (Tracked& t : tracked_) {
    // Both far: a pixel of disparity more or less is no change of scale worth speaking of.
    const float change = (t.disparity + 1.0F) / (t.reference_disparity + 1.0F);
    const auto bound = static_cast<float>(options_.reference_scale);
    if (t.reference == kNoReference || change > bound || change < 1.0F / bound) renew(t);
    needed.insert(t.reference);
  }
  // Slow or standing, a vehicle would end with a picture for every track.
  while (needed.size() > kMaxReferences) {
    const std::uint64_t oldest = *needed.begin();
    for (Tracked& t : tracked_) {
      if (t.reference == oldest) renew(t);
    }
    needed.erase(oldest);
    needed.insert(frame_);
  }
  std::erase_if(references_, [&](const auto& entry) { return !needed.contains(entry.first); });
}

// Fills the grid's empty places with the strongest corners, cell by cell.
void StereoTracker::Detect(const cv::Mat& left) {
  const int cells = options_.grid_columns * options_.grid_rows;
  const int per_cell = std::max(1, options_.max_features / cells);
  const auto cell_of = [&](const cv::Point2f& p) {
    const int column = std::min(static_cast<int>(p.x * options_.grid_columns / left.cols),
                                options_.grid_columns - 1);
    const int row =
        std::min(static_cast<int>(p.y * options_.grid_rows / left.rows), options_.grid_rows - 1);
    return row * options_.grid_columns + column;
  };
  std::vector<int> filled(static_cast<std::size_t>(cells), 0);
  cv::Mat mask(left.size(), CV_8UC1, cv::Scalar(255));
  for (const Tracked& t : tracked_) {
    ++filled[static_cast<std::size_t>(cell_of(t.raw))];
    cv::circle(mask, t.raw, options_.min_distance_px, cv::Scalar(0), cv::FILLED);
  }
  if (static_cast<int>(tracked_.size()) >= options_.max_features) return;
  std::vector<cv::Point2f> corners;
  cv::goodFeaturesToTrack(left, corners, 0, options_.corner_quality, options_.min_distance_px, mask,
                          5);
  std::vector<cv::Point2f> fresh;
  for (const cv::Point2f& corner : corners) {
    int& count = filled[static_cast<std::size_t>(cell_of(corner))];
    if (count >= per_cell) continue;
    if (static_cast<int>(tracked_.size() + fresh.size()) >= options_.max_features) break;
    ++count;
    fresh.push_back(corner);
  }
  for (const cv::Point2f& p : fresh)
    tracked_.push_back({.id = next_id_++, .raw = p, .reference = kNoReference});
}

StereoFeatures StereoTracker::MatchStereo(TimeNs stamp, const Pyramid& right) {
  std::vector<cv::Point2f> in_left;
  std::vector<cv::Point2f> in_right;
  for (const Tracked& t : tracked_) {
    in_left.push_back(t.raw);
    in_right.push_back(t.raw - cv::Point2f(t.disparity, 0.0F));
  }
  const std::vector<bool> ok = FollowBothWays(pyramid_, right, in_left, in_right, options_);
  const std::vector<cv::Point2f> rectified_left = rectifier_.RectifyLeft(in_left);
  const std::vector<cv::Point2f> rectified_right = rectifier_.RectifyRight(in_right);
  StereoFeatures features{.stamp = stamp};
  for (std::size_t i = 0; i < tracked_.size(); ++i) {
    const cv::Point2f l = rectified_left[i];
    const cv::Point2f r = rectified_right[i];
    FeatureObservation observation{.id = tracked_[i].id, .uv_left_px = {l.x, l.y}};
    // Far points may come out slightly behind infinity; the noise of a match decides how much.
    const bool plausible = l.x - r.x > -options_.epipolar_px &&
                           l.x - r.x < options_.max_disparity_px &&
                           std::abs(l.y - r.y) < options_.epipolar_px;
    if (ok[i] && plausible) {
      observation.u_right_px = r.x;
      tracked_[i].disparity = in_left[i].x - in_right[i].x;
    }
    features.features.push_back(observation);
  }
  return features;
}

}  // namespace polnav::nav
