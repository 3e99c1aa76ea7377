// What does a ZED-like stereo camera deliver?
//
// Raw, distorted, 8-bit grey pairs, linear in light. The renderer draws an ideal pinhole image that
// covers the lens's view at 0.75 of its focal length (which stands in for the softness of a small
// lens), a warp bends it, then shot and read noise are added. The exposure is an instant: no motion
// blur, no rolling shutter. Both cameras look at the same instant with the same exposure.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>

#include "nav/api/calibration.h"
#include "nav/api/measurements.h"
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

  // Depends on its arguments alone. index: of the frame, for the noise.
  [[nodiscard]] nav::StereoImages Capture(const nav::Pose& T_WB, nav::TimeNs stamp,
                                          std::uint64_t index);

  // The gain in use, given or found by the constructor.
  [[nodiscard]] double exposure() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polnav::sim
