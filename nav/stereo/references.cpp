#include "nav/stereo/references.h"

namespace polnav::nav {
namespace {

constexpr float kLeastCorrelation = 0.8F;

bool LooksOtherwise(const FollowedPoint& track, const TrackerOptions& options) {
  if (!track.disparity || !track.reference_disparity) return false;  // nobody can say
  // Both far: a pixel of disparity more or less is no change of scale worth speaking of.
  const float change = (*track.disparity + 2.0F) / (*track.reference_disparity + 2.0F);
  const auto bound = static_cast<float>(options.reference_scale);
  return change > bound || change < 1.0F / bound;
}

}  // namespace

void HoldToReferences(const Pyramid& pyramid, const TrackerOptions& options,
                      std::vector<FollowedPoint>& tracks) {
  const auto limit = static_cast<float>(options.reference_px);
  for (FollowedPoint& t : tracks) {
    if (!t.reference) continue;
    const auto place =
        AlignTemplate(*t.reference, pyramid[0], {t.raw, t.stretch}, kLeastCorrelation);
    const cv::Point2f d = place ? place->at - t.raw : cv::Point2f();
    if (place && d.dot(d) < limit * limit) {
      t.raw = place->at;
      t.stretch = place->stretch;
    } else {
      t.reference.reset();
    }
  }
}

void RenewReferences(const Pyramid& pyramid, const TrackerOptions& options,
                     std::vector<FollowedPoint>& tracks) {
  for (FollowedPoint& t : tracks) {
    if (t.reference && !LooksOtherwise(t, options)) continue;
    t.reference = CutTemplate(pyramid[0], t.raw, options.window_px / 2);
    t.reference_disparity = t.disparity;
    t.stretch = cv::Matx22f::eye();
  }
}

}  // namespace polnav::nav
