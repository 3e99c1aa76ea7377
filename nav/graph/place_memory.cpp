#include "nav/graph/place_memory.h"

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>

namespace polnav::nav {
namespace {

// A match must be this much nearer in Hamming distance than the second best [Lowe2004].
constexpr float kDistinctness = 0.8F;

}  // namespace

const PlaceMemory::Place* PlaceMemory::Nearest(const Pose& T_WB) const {
  const Place* nearest = nullptr;
  for (const Place& place : places_) {
    if (place.T_WB.q.angularDistance(T_WB.q) > DegToRad(options_.search_angle_deg)) continue;
    if (nearest == nullptr || (place.T_WB.p - T_WB.p).norm() < (nearest->T_WB.p - T_WB.p).norm()) {
      nearest = &place;
    }
  }
  return nearest;
}

std::vector<LandmarkView> PlaceMemory::Match(const RectifiedCamera& camera, const Place& place,
                                             const Pose& T_WB,
                                             const StereoFeatures& features) const {
  std::vector<std::vector<cv::DMatch>> matches;
  cv::BFMatcher(cv::NORM_HAMMING).knnMatch(features.descriptors, place.descriptors, matches, 2);
  std::vector<LandmarkView> views;
  for (const std::vector<cv::DMatch>& m : matches) {
    if (m.size() < 2 || m[0].distance > kDistinctness * m[1].distance) continue;
    const FeatureObservation& f = features.features[static_cast<std::size_t>(m[0].queryIdx)];
    const LandmarkView view{.id = f.id,
                            .T_WBh = &place.T_WB,
                            .landmark = place.landmarks[static_cast<std::size_t>(m[0].trainIdx)],
                            .pixel = PixelOf(f)};
    const auto e = Reproject(camera, place.T_WB, T_WB, view.landmark, view.pixel, {1.0, 1.0});
    if (e && e->residual.head<2>().norm() < options_.match_radius_px) views.push_back(view);
  }
  return views;
}

std::optional<PoseEdge> PlaceMemory::Recognize(const RectifiedCamera& camera, TimeNs stamp,
                                               const Pose& T_WB, const StereoFeatures& features,
                                               const PoseSolverOptions& solver) {
  if (!options_.enabled || features.descriptors.empty()) return std::nullopt;
  const Place* place = Nearest(T_WB);
  if (place == nullptr || (place->T_WB.p - T_WB.p).norm() > options_.search_radius_m ||
      ToSeconds(stamp - place->stamp) < options_.min_age_s) {
    return std::nullopt;
  }
  const std::vector<LandmarkView> views = Match(camera, *place, T_WB, features);
  const auto fix = SolvePose(camera, views, T_WB, solver, options_.min_inliers);
  // Chance agreement of a minority is no fix.
  if (!fix || 2 * fix->inliers < static_cast<int>(views.size())) return std::nullopt;
  const double since = last_fix_ ? ToSeconds(stamp - *last_fix_) : options_.correlation_time_s;
  const double share = std::max(1.0, 2.0 * options_.correlation_time_s / std::max(since, 1e-3));
  last_fix_ = stamp;
  return PoseEdge{.T_WB = fix->T_WB,
                  .position_sigma_m = options_.position_sigma_m * std::sqrt(share),
                  .angle_sigma_rad = DegToRad(options_.angle_sigma_deg) * std::sqrt(share)};
}

void PlaceMemory::Remember(const RectifiedCamera& camera, TimeNs stamp, const Pose& T_WB,
                           const StereoFeatures& features) {
  if (!options_.enabled || features.descriptors.empty()) return;
  const Place* nearest = Nearest(T_WB);
  if (nearest != nullptr && (nearest->T_WB.p - T_WB.p).norm() < options_.spacing_m) return;
  Place place{.stamp = stamp, .T_WB = T_WB};
  for (std::size_t i = 0; i < features.features.size(); ++i) {
    const StereoPixel pixel = PixelOf(features.features[i]);
    if (!pixel.disparity_px) continue;
    place.landmarks.push_back(LandmarkOf(camera, pixel));
    place.descriptors.push_back(features.descriptors.row(static_cast<int>(i)));
  }
  if (!place.landmarks.empty()) places_.push_back(std::move(place));
}

}  // namespace polnav::nav
