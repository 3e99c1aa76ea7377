// What would the optical-flow sensor make of pictures, where none are drawn?
//
// The measurement level's camera. The true displacement of the picture from frame to frame is that
// of the ground on the optical axis; what block matching (block_matching.h) makes of real pictures
// of it is added: docs/optical_flow.md has the fit. The error of a displacement, on each axis, is
//   e_k = s (a_k - r a_k-1 - sqrt(1 - r^2) b_k)   [px],   r = exp(-(shift / texture_length)^2)
// a, b: white. What the pixel noise of picture k adds to its displacement is taken back by the next
// one (r = 1) as long as the ground hardly moves; else errors are white. s grows as contrast falls,
// and falls with the ground that a pixel covers. How many blocks match falls as s grows. Beyond the
// search range nothing is found.
// Not in it: paint, cracks, kerbs and shadows' edges, which help or mislead for a moment; light
// that is too weak; the mean error of some 0.0005 px that depends on the shift's fraction.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "nav/api/measurements.h"
#include "sim/random.h"
#include "sim/sensors/flow_interval.h"
#include "sim/sensors/optical_flow.h"
#include "sim/sensors/optical_flow_options.h"

namespace polnav::sim {

// White noise of the integrated flow at 0.4 m over ordinary ground, for the nominal calibration.
[[nodiscard]] double TypicalFlowNoise(const OpticalFlowOptions& options);

// The picture's true motion between two frames. Absent: one of them sees nothing.
[[nodiscard]] std::optional<Eigen::Vector2d> TrueShift(const FlowFrame& before,
                                                       const FlowFrame& after, double focal_px);

class OpticalFlowModel {
 public:
  OpticalFlowModel(const OpticalFlowOptions& options, double grain_contrast, std::uint64_t seed,
                   std::uint64_t trial);

  // In order: errors follow from those before.
  [[nodiscard]] nav::OpticalFlowSample Take(const FlowInterval& interval);

 private:
  void ComeTo(double distance_m);
  [[nodiscard]] PictureShift Match(const FlowFrame& before, const FlowFrame& after,
                                   std::uint64_t frame);

  OpticalFlowOptions options_;
  double grain_contrast_;
  double focal_px_;        // true
  double sigma_px_ = 0.0;  // s, and
  double share_ = 0.0;     // of the blocks that match, at the current distance
  RandomStream noise_;
  Eigen::Vector2d after_ = Eigen::Vector2d::Zero();  // a
  double luck_ = 0.0;                                // of the share that matches, in sigmas
};

}  // namespace polnav::sim
