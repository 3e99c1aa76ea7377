// Which of a frame's features are landmarks of the window, and which become new ones?
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "nav/api/measurements.h"
#include "nav/graph/window.h"
#include "nav/stereo/pose_solver.h"
#include "nav/stereo/rectifier.h"

namespace polnav::nav {

// Tracks that do not belong to the static scene: what moves leaves the map and does not come back.
class RejectedTracks {
 public:
  void Add(std::uint64_t id) { ids_.insert(id); }
  [[nodiscard]] bool Contains(std::uint64_t id) const { return ids_.contains(id); }

  // Ids are never used again once lost, so only those still seen need to be remembered.
  void KeepOnly(const StereoFeatures& seen);

 private:
  std::set<std::uint64_t> ids_;
};

[[nodiscard]] std::vector<LandmarkView> MatchLandmarks(const RectifiedCamera& camera,
                                                       const Window& window,
                                                       const StereoFeatures& features);

// What the window's newest keyframe sees: of old landmarks what is trusted, and new landmarks of
// what has a stereo match and was never rejected. Returns how many.
int AddSightings(const RectifiedCamera& camera, const StereoFeatures& features,
                 const std::vector<LandmarkView>& trusted, const RejectedTracks& rejected,
                 Window& window);

}  // namespace polnav::nav
