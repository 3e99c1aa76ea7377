#include "nav/stereo/references.h"

#include <set>

#include "nav/stereo/patch_align.h"

namespace polnav::nav {
namespace {

// Pictures kept, 1.5 MB each at VGA; driving needs about thirty.
constexpr std::size_t kMaxReferences = 48;
constexpr double kLeastCorrelation = 0.8;

}  // namespace

void References::Hold(const Pyramid& pyramid, std::vector<FollowedPoint>& tracks) const {
  const auto limit = static_cast<float>(options_.reference_px);
  PatchAligner aligner(options_.window_px / 2, kLeastCorrelation);
  for (FollowedPoint& t : tracks) {
    if (!t.reference) continue;
    const auto place =
        aligner.Align(pictures_.at(*t.reference), t.reference_raw, pyramid[0], {t.raw, t.stretch});
    const cv::Point2f d = place ? place->at - t.raw : cv::Point2f();
    if (place && d.dot(d) < limit * limit) {
      t.raw = place->at;
      t.stretch = place->stretch;
    } else {
      t.reference.reset();
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
  pictures_[frame_] = pyramid[0];
  const auto renew = [this](FollowedPoint& t) {
    t.reference = frame_;
    t.reference_raw = t.raw;
    t.reference_disparity = t.disparity;
    t.stretch = cv::Matx22f::eye();
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
