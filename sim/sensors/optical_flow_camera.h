// What does the optical-flow sensor make of the pictures it takes?
//
// At image level: the ground is drawn through the true camera at every frame, with its grain
// (sim/render/renderer.h), exposed, made noisy, and matched block by block. The exposure follows
// the light: the mean of an interval's first picture is brought to target_mean. The vehicle itself
// is not drawn and casts no shadow. Not in it: motion blur, distortion (2.7 degrees from the axis
// there is none to speak of), flicker of lamps, drops and dirt on the lens.
#pragma once

#include <cstdint>
#include <memory>

#include "nav/api/measurements.h"
#include "sim/sensors/flow_interval.h"
#include "sim/sensors/optical_flow.h"
#include "sim/world/scene.h"
#include "sky/skylight.h"

namespace polnav::sim {

// One object a thread (see sim/render/renderer.h); the scene is copied.
class OpticalFlowCamera {
 public:
  // grain_contrast: of the ground's grain, one sigma over its mean.
  OpticalFlowCamera(const Scene& scene, const sky::WorldSky& sky, const OpticalFlowOptions& options,
                    double grain_contrast, std::uint64_t seed, std::uint64_t trial);
  ~OpticalFlowCamera();
  OpticalFlowCamera(const OpticalFlowCamera&) = delete;
  OpticalFlowCamera& operator=(const OpticalFlowCamera&) = delete;

  // Depends on its argument alone.
  [[nodiscard]] nav::OpticalFlowSample Take(const FlowInterval& interval);

  // The picture of one of its frames, CV_8UC1.
  [[nodiscard]] cv::Mat Picture(const FlowInterval& interval, std::size_t frame);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polnav::sim
