// Is a track still where it began?
//
// A track that is followed from frame to frame wanders off its point a little each time. Held
// against the picture where it began, shifted and stretched (patch_align.h), it does not, as long
// as the point still looks the same: until it has come much nearer, or something else is in its
// place.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "nav/stereo/options.h"
#include "nav/stereo/patch_align.h"
#include "nav/stereo/patch_flow.h"

namespace polnav::nav {

struct FollowedPoint {
  std::uint64_t id = 0;
  cv::Point2f raw;                 // in the newest left image
  cv::Point2f flow{0.0F, 0.0F};    // raw displacement since the image before
  std::optional<float> disparity;  // rectified, where one was matched in the newest pair
  // What it looked like where it began, and how near it was.
  std::optional<PatchTemplate> reference;
  std::optional<float> reference_disparity;
  cv::Matx22f stretch = cv::Matx22f::eye();  // of its surroundings, since then
};

// Corrects the tracks' places in a new left picture. One that departs too far from what the frame
// before says loses its reference.
void HoldToReferences(const Pyramid& pyramid, const TrackerOptions& options,
                      std::vector<FollowedPoint>& tracks);

// Takes the newest left picture as reference of what has none or sees it from too near or too far.
void RenewReferences(const Pyramid& pyramid, const TrackerOptions& options,
                     std::vector<FollowedPoint>& tracks);

}  // namespace polnav::nav
