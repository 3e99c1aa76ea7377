// How bright will the next picture be taken?
//
// A camera that meters for itself: the exposure follows the mean grey of the left picture, the
// logarithm of the error falling by e in each time constant. The first picture is exposed right;
// each later one by what the ones before it saw, so this must be asked in order of frames, which
// the threads that take pictures cannot promise: it looks at small pictures of its own (48 pixels
// wide, no noise) in the simulator's thread. Glare and fog count, dirt and drops do not.
#pragma once

#include <memory>

#include "nav/api/calibration.h"
#include "sim/sensors/frame_request.h"
#include "sim/sensors/stereo_options.h"
#include "sim/world/scene.h"
#include "sky/skylight.h"

namespace polnav::sim {

// One object a thread, like the renderer inside.
class AutoExposure {
 public:
  AutoExposure(const Scene& scene, const sky::WorldSky& sky, const nav::CameraCalibration& left,
               const StereoCameraOptions& options);
  ~AutoExposure();
  AutoExposure(const AutoExposure&) = delete;
  AutoExposure& operator=(const AutoExposure&) = delete;

  // The exposure for this frame; then looks at what it shows.
  [[nodiscard]] double Next(const FrameRequest& request);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polnav::sim
