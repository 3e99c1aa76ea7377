// What would the optical-flow sensor make of pictures, where none are drawn?
//
// The measurement level's camera. The true displacement of the picture from frame to frame is that
// of the ground on the optical axis; what block matching (block_matching.h) makes of real pictures
// of it is added: docs/optical_flow.md has the fit. Errors of one displacement, each axis:
//   e_k = s (n_k - n_k-1) + m u_k        [px]
// n: white, of a picture's pixel noise, which a displacement there takes back; u: of the picture's
// content, white from texture_length_px of way to the next. Both grow as contrast falls and as
// pixels cover more ground than the grain's. Beyond the search range nothing is found.
// Not in it: paint, cracks, kerbs and shadows' edges, which help or mislead for a moment.
#pragma once

#include <Eigen/Core>
#include <cstdint>

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
  [[nodiscard]] PictureShift Match(const FlowFrame& before, const FlowFrame& after,
                                   std::uint64_t frame);

  OpticalFlowOptions options_;
  double grain_contrast_;
  double focal_px_;  // true
  int blocks_;
  RandomStream noise_;
  Eigen::Vector2d pixels_ = Eigen::Vector2d::Zero();   // n of the frame before
  Eigen::Vector2d content_ = Eigen::Vector2d::Zero();  // u
};

}  // namespace polnav::sim
