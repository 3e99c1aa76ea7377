// Is a track still where it began?
//
// A track that is followed from frame to frame wanders off its point a little each time. Held
// against the picture where it began, shifted and stretched (patch_align.h), it does not, as long
// as the point still looks the same: until it has come much nearer, or something else is in its
// place.
#pragma once

#include <cstdint>
#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "nav/stereo/options.h"
#include "nav/stereo/patch_flow.h"

namespace polnav::nav {

struct FollowedPoint {
  std::uint64_t id = 0;
  cv::Point2f raw;                 // in the newest left image
  cv::Point2f flow{0.0F, 0.0F};    // raw displacement since the image before
  std::optional<float> disparity;  // rectified, where one was matched in the newest pair
  // The picture that the point is held against.
  std::optional<std::uint64_t> reference;  // its number
  cv::Point2f reference_raw;               // where the point is there
  std::optional<float> reference_disparity;
  cv::Matx22f stretch = cv::Matx22f::eye();  // of its surroundings, since then
};

class References {
 public:
  explicit References(const TrackerOptions& options) : options_(options) {}

  // Corrects the tracks' places in a new left picture. One that departs too far from what the frame
  // before says loses its reference.
  void Hold(const Pyramid& pyramid, std::vector<FollowedPoint>& tracks) const;

  // Takes the newest left picture as reference of what has none or sees it from too near or too
  // far; forgets what nobody needs.
  void Renew(const Pyramid& pyramid, std::vector<FollowedPoint>& tracks);

 private:
  [[nodiscard]] bool LooksOtherwise(const FollowedPoint& track) const;

  TrackerOptions options_;
  std::uint64_t frame_ = 0;
  std::map<std::uint64_t, cv::Mat> pictures_;  // full size, by number
};

}  // namespace polnav::nav
