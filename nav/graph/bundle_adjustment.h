// Which poses and landmarks fit everything in the window best?
//
// Minimizes [Chu2021, eq. 16] over the sliding window by Levenberg-Marquardt: Huber-robust stereo
// reprojections and IMU sums, headings, and the marginalization prior.
#pragma once

#include "nav/graph/normal_equations.h"
#include "nav/graph/window.h"
#include "nav/stereo/rectifier.h"

namespace polnav::nav {

struct BundleAdjustmentSummary {
  bool usable = false;
  int iterations = 0;
  double initial_cost = 0.0;
  double final_cost = 0.0;
  NormalEquations equations;  // next to where the window is now
};

[[nodiscard]] BundleAdjustmentSummary AdjustBundle(const RectifiedCamera& camera,
                                                   const BundleAdjustmentOptions& options,
                                                   Window& window);

// Removes sightings further than this from where the adjusted window predicts them, and landmarks
// left with none. Returns the track ids of removed landmarks.
std::vector<std::uint64_t> RemoveOutliers(const RectifiedCamera& camera, const PixelSigmas& sigmas,
                                          double max_sigmas, Window& window);

}  // namespace polnav::nav
