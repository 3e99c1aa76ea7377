#include "nav/graph/place_memory.h"

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>

namespace polnav::nav {
namespace {

// A match must be this much nearer in Hamming distance than the second best [Lowe2004].
constexpr float kDistinctness = 0.8F;

}  // namespace

const PlaceMemory::Place* PlaceMemory::Nearest(const std::vector<GraphNode>& nodes) const {
  const Pose& here = nodes.back().T_WB;
  const Place* nearest = nullptr;
  double distance = options_.search_radius_m;
  for (const Place& place : places_) {
    const Pose& there = nodes[place.node].T_WB;
    const double d = (there.p - here.p).norm();
    if (d >= distance || there.q.angularDistance(here.q) > DegToRad(options_.search_angle_deg)) {
      continue;
    }
    nearest = &place;
    distance = d;
  }
  return nearest;
}

std::vector<LandmarkView> PlaceMemory::Match(const RectifiedCamera& camera, const Place& place,
                                             const Pose& T_WBh, const Pose& T_WB,
                                             const StereoFeatures& features) const {
  std::vector<std::vector<cv::DMatch>> matches;
  cv::BFMatcher(cv::NORM_HAMMING).knnMatch(features.descriptors, place.descriptors, matches, 2);
  const Viewpoint host = ViewpointOf(camera, T_WBh);
  const Viewpoint here = ViewpointOf(camera, T_WB);
  std::vector<LandmarkView> views;
  for (const std::vector<cv::DMatch>& m : matches) {
    if (m.size() < 2 || m[0].distance > kDistinctness * m[1].distance) continue;
    const FeatureObservation& f = features.features[static_cast<std::size_t>(m[0].queryIdx)];
    const LandmarkView view{.id = f.id,
                            .host = host,
                            .landmark = place.landmarks[static_cast<std::size_t>(m[0].trainIdx)],
                            .pixel = PixelOf(f)};
    const auto e = Reproject(camera, host, here, view.landmark, view.pixel, {1.0, 1.0});
    if (e && e->residual.head<2>().norm() < options_.match_radius_px) views.push_back(view);
  }
  return views;
}

std::optional<RelativeEdge> PlaceMemory::Recognize(const RectifiedCamera& camera,
                                                   const std::vector<GraphNode>& nodes,
                                                   const StereoFeatures& features,
                                                   const PoseSolverOptions& solver) {
  if (features.descriptors.empty()) return std::nullopt;
  const GraphNode& now = nodes.back();
  const Place* place = Nearest(nodes);
  if (place == nullptr) return std::nullopt;
  const GraphNode& then = nodes[place->node];
  if (ToSeconds(now.stamp - then.stamp) < options_.min_age_s) return std::nullopt;
  const std::vector<LandmarkView> views = Match(camera, *place, then.T_WB, now.T_WB, features);
  const auto fix = SolvePose(camera, views, now.T_WB, solver, options_.min_inliers);
  // Chance agreement of a minority is no return.
  if (!fix || 2 * fix->inliers < static_cast<int>(views.size())) return std::nullopt;
  const double since =
      last_return_ ? ToSeconds(now.stamp - *last_return_) : options_.correlation_time_s;
  const double share = std::max(1.0, 2.0 * options_.correlation_time_s / std::max(since, 1e-3));
  last_return_ = now.stamp;
  return RelativeEdge{.from = place->node,
                      .to = nodes.size() - 1,
                      .T_ft = then.T_WB.Inverse() * fix->T_WB,
                      .position_sigma_m = options_.position_sigma_m * std::sqrt(share),
                      .angle_sigma_rad = DegToRad(options_.angle_sigma_deg) * std::sqrt(share)};
}

void PlaceMemory::Remember(const RectifiedCamera& camera, const std::vector<GraphNode>& nodes,
                           const StereoFeatures& features) {
  if (features.descriptors.empty()) return;
  const Place* nearest = Nearest(nodes);
  if (nearest != nullptr &&
      (nodes[nearest->node].T_WB.p - nodes.back().T_WB.p).norm() < options_.spacing_m) {
    return;
  }
  Place place{.node = nodes.size() - 1};
  for (std::size_t i = 0; i < features.features.size(); ++i) {
    const StereoPixel pixel = PixelOf(features.features[i]);
    if (!pixel.disparity_px) continue;
    place.landmarks.push_back(LandmarkOf(camera, pixel));
    place.descriptors.push_back(features.descriptors.row(static_cast<int>(i)));
  }
  if (!place.landmarks.empty()) places_.push_back(std::move(place));
}

}  // namespace polnav::nav
