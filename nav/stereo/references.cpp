#include "nav/stereo/references.h"

#include <set>

namespace polnav::nav {
namespace {

// Pictures kept, 1.5 MB each at VGA; driving needs about thirty.
constexpr std::size_t kMaxReferences = 48;

}  // namespace

void References::Hold(const Pyramid& pyramid, std::vector<FollowedPoint>& tracks) const {
  std::map<std::uint64_t, std::vector<FollowedPoint*>> by_reference;
  for (FollowedPoint& t : tracks) {
    if (t.reference) by_reference[*t.reference].push_back(&t);
  }
  const auto limit = static_cast<float>(options_.reference_px);
  for (const auto& [reference, held] : by_reference) {
    std::vector<cv::Point2f> from;
    std::vector<cv::Point2f> to;
    for (const FollowedPoint* t : held) {
      from.push_back(t->reference_raw);
      to.push_back(t->raw);
    }
    const std::vector<bool> ok = FollowNear(pictures_.at(reference), pyramid, from, to, options_);
    for (std::size_t i = 0; i < held.size(); ++i) {
      const cv::Point2f d = to[i] - held[i]->raw;
      if (ok[i] && d.dot(d) < limit * limit) {
        held[i]->raw = to[i];
      } else {
        held[i]->reference.reset();
      }
    }
  }
}

bool References::LooksOtherwise(const FollowedPoint& track) const {
  if (!track.disparity || !track.reference_disparity) return false;  // nobody can say
  // Both far: a pixel of disparity more or less is no change of scale worth speaking of.
  const float change = (*track.disparity + 2.0F) / (*track.reference_disparity + 2.0F);
  const auto bound = static_cast<float>(options_.reference_scale);
  return change > bound || change < 1.0F / bound;
}

void References::Renew(const Pyramid& pyramid, std::vector<FollowedPoint>& tracks) {
  ++frame_;
  pictures_[frame_] = {pyramid[0], pyramid[1]};
  const auto renew = [this](FollowedPoint& t) {
    t.reference = frame_;
    t.reference_raw = t.raw;
    t.reference_disparity = t.disparity;
  };
  std::set<std::uint64_t> needed;
  for (FollowedPoint& t : tracks) {
    if (!t.reference || LooksOtherwise(t)) renew(t);
    needed.insert(*t.reference);
  }
  // Slow or standing, a vehicle would end with a picture for every track.
  while (needed.size() > kMaxReferences) {
    const std::uint64_t oldest = *needed.begin();
    for (FollowedPoint& t : tracks) {
      if (t.reference == oldest) renew(t);
    }
    needed.erase(oldest);
    needed.insert(frame_);
  }
  std::erase_if(pictures_, [&](const auto& entry) { return !needed.contains(entry.first); });
}

}  // namespace polnav::nav
