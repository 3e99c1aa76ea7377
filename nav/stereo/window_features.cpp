#include "nav/stereo/window_features.h"

#include <utility>

namespace polnav::nav {

void RejectedTracks::KeepOnly(const StereoFeatures& seen) {
  std::set<std::uint64_t> kept;
  for (const FeatureObservation& f : seen.features) {
    if (ids_.contains(f.id)) kept.insert(f.id);
  }
  ids_ = std::move(kept);
}

std::vector<LandmarkView> MatchLandmarks(const RectifiedCamera& camera, const Window& window,
                                         const StereoFeatures& features) {
  const std::vector<Viewpoint> viewpoints = ViewpointsOf(camera, window);
  std::vector<LandmarkView> views;
  for (const FeatureObservation& f : features.features) {
    const auto found = window.landmarks.find(f.id);
    if (found == window.landmarks.end()) continue;
    views.push_back({.id = f.id,
                     .host = viewpoints[IndexOf(window, found->second.host)],
                     .landmark = found->second.coordinates,
                     .pixel = PixelOf(f),
                     .proven = found->second.sightings.size() > 1});
  }
  return views;
}

int AddSightings(const RectifiedCamera& camera, const StereoFeatures& features,
                 const std::vector<LandmarkView>& trusted, const RejectedTracks& rejected,
                 Window& window) {
  const std::uint64_t newest = window.keyframes.back().id;
  std::set<std::uint64_t> trusted_ids;
  for (const LandmarkView& view : trusted) trusted_ids.insert(view.id);
  int added = 0;
  for (const FeatureObservation& f : features.features) {
    const auto found = window.landmarks.find(f.id);
    const StereoPixel pixel = PixelOf(f);
    if (found != window.landmarks.end()) {
      if (!trusted_ids.contains(f.id)) continue;
      found->second.sightings.push_back({newest, pixel});
    } else if (pixel.disparity_px && !rejected.Contains(f.id)) {
      window.landmarks[f.id] = {
          .host = newest, .coordinates = LandmarkOf(camera, pixel), .sightings = {{newest, pixel}}};
    } else {
      continue;
    }
    ++added;
  }
  return added;
}

}  // namespace polnav::nav
