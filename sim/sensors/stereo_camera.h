// What does a ZED-like stereo camera deliver?
//
// Raw, distorted, 8-bit grey pairs, linear in light. The renderer draws an ideal pinhole image that
// covers the lens's view at 0.75 of its focal length (which stands in for the softness of a small
// lens), a warp bends it, then shot and read noise are added. Unless options say otherwise
// (sim/sensors/shutter.h) the exposure is an instant: no motion blur, no rolling shutter. Both
// cameras look at the same instants with the same exposure: a pair is synchronous to the
// nanosecond.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>

#include "nav/api/calibration.h"
#include "nav/api/measurements.h"
#include "sim/sensors/frame_request.h"
#include "sim/sensors/frame_truth.h"
#include "sim/sensors/stereo_options.h"
#include "sim/world/scene.h"
#include "sky/skylight.h"

namespace polnav::sim {

// What the estimator believes.
[[nodiscard]] nav::StereoCalibration NominalStereo(const StereoCameraOptions& options);

// The truth of one trial: nominal plus what the calibration missed.
[[nodiscard]] nav::StereoCalibration DrawTrueStereo(const StereoCameraOptions& options,
                                                    std::uint64_t seed, std::uint64_t trial);

// One object a thread (see sim/render/renderer.h); the scene is copied.
class StereoCamera {
 public:
  StereoCamera(const Scene& scene, const sky::WorldSky& sky, const nav::StereoCalibration& truth,
               const StereoCameraOptions& options, std::uint64_t seed, std::uint64_t trial);
  ~StereoCamera();
  StereoCamera(const StereoCamera&) = delete;
  StereoCamera& operator=(const StereoCamera&) = delete;

  // Depends on its argument alone.
  [[nodiscard]] nav::StereoImages Capture(const FrameRequest& request);
  // Of a camera that stands still, in clear air.
  [[nodiscard]] nav::StereoImages Capture(const nav::Pose& T_WB, nav::TimeNs stamp,
                                          std::uint64_t index) {
    return Capture({.stamp = stamp, .index = index, .T_WB = T_WB});
  }

  // Of the left camera; of a camera made with options.ground_truth.
  [[nodiscard]] FrameTruth CaptureTruth(const FrameTruthRequest& request);

  // The gain in use when none is asked for, given or found by the constructor.
  [[nodiscard]] double exposure() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polnav::sim
