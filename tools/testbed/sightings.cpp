#include "tools/testbed/sightings.h"

#include <algorithm>
#include <cmath>

namespace polnav::testbed {
namespace {

cv::Point2f ToCv(const Eigen::Vector2d& pixel) {
  return {static_cast<float>(pixel.x()), static_cast<float>(pixel.y())};
}

bool IsSame(const nav::FeatureObservation& a, const nav::FeatureObservation& b) {
  return a.id == b.id && a.uv_left_px == b.uv_left_px && a.u_right_px == b.u_right_px;
}

}  // namespace

nav::StereoFeatures SightingsRectifier::Rectify(const sim::FeatureSightings& seen) const {
  std::vector<cv::Point2f> in_left;
  std::vector<cv::Point2f> in_right;
  for (const sim::FeatureSighting& s : seen.sightings) {
    in_left.push_back(ToCv(s.left_px));
    in_right.push_back(ToCv(s.right_px.value_or(s.left_px)));
  }
  const std::vector<cv::Point2f> left = rectifier_.RectifyLeft(in_left);
  const std::vector<cv::Point2f> right = rectifier_.RectifyRight(in_right);
  nav::StereoFeatures features{.stamp = seen.stamp};
  if (describe_) {
    features.descriptors = cv::Mat(static_cast<int>(seen.sightings.size()), 32, CV_8UC1);
  }
  for (std::size_t i = 0; i < seen.sightings.size(); ++i) {
    const sim::FeatureSighting& s = seen.sightings[i];
    nav::FeatureObservation& f = features.features.emplace_back();
    f.id = s.id;
    f.uv_left_px = {left[i].x, left[i].y};
    const double disparity = left[i].x - right[i].x;
    const bool plausible = disparity > -options_.epipolar_px &&
                           disparity < options_.max_disparity_px &&
                           std::abs(left[i].y - right[i].y) < options_.epipolar_px;
    if (s.right_px && plausible) f.u_right_px = right[i].x;
    if (describe_) {
      std::copy(s.descriptor.begin(), s.descriptor.end(),
                features.descriptors.ptr(static_cast<int>(i)));
    }
  }
  return features;
}

bool IsNews(const nav::StereoFeatures& features, const nav::StereoFeatures& newest) {
  if (features.stamp <= newest.stamp) return false;
  return features.features.empty() ||
         !std::equal(features.features.begin(), features.features.end(), newest.features.begin(),
                     newest.features.end(), IsSame);
}

}  // namespace polnav::testbed
