// What does a front end get wrong about a point that it sees?
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "sim/random.h"
#include "sim/sensors/feature_options.h"

namespace polnav::sim {

// Of a track, all along.
struct TrackErrors {
  Eigen::Vector2d patch_px = Eigen::Vector2d::Zero();  // from the point to the patch's middle
  double false_match_px = 0.0;  // along the row in the right image; zero but for false matches
};
[[nodiscard]] TrackErrors DrawTrackErrors(const FeatureOptions& options, RandomStream::Sample draw);

// By how far a track has left its point, which was first seen at one distance and is now at
// another.
[[nodiscard]] inline Eigen::Vector2d Slip(const TrackErrors& errors, double first_m, double now_m) {
  return (first_m / now_m - 1.0) * errors.patch_px;
}

// Of one sighting: the left one's, and the right one's, which is matched with the left one.
struct SightingErrors {
  Eigen::Vector2d left_px;
  Eigen::Vector2d right_px;
  bool right_lost;
};
// Draws as many numbers whatever comes of them.
[[nodiscard]] SightingErrors DrawSightingErrors(const FeatureOptions& options,
                                                RandomStream::Sample& draw);

using Descriptor = std::array<std::uint8_t, 32>;

// own: of the point, always the same.
[[nodiscard]] Descriptor DescriptorOf(RandomStream::Sample own, int flipped_bits,
                                      RandomStream::Sample& flips);

}  // namespace polnav::sim
