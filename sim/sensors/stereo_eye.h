// What does one camera of the pair make of the ideal image in front of it?
//
// Behind the lens's distortion, in the order of the light's way: drops and dirt on the lens, glare
// and vignetting inside it, then the sensor's noise. What is off costs nothing and leaves every
// byte as it is.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>

#include "nav/api/calibration.h"
#include "sim/random.h"
#include "sim/render/pinhole_view.h"
#include "sim/sensors/frame_request.h"
#include "sim/sensors/glare.h"
#include "sim/sensors/lens_dirt.h"
#include "sim/sensors/lens_rain.h"
#include "sim/sensors/lens_warp.h"
#include "sim/sensors/pixel_noise.h"
#include "sim/sensors/stereo_options.h"
#include "sim/sensors/vignetting.h"

namespace polnav::sim {

// How a picture is exposed.
struct PictureExposure {
  double drawn = 0.0;  // of the image that comes in: 255 is radiance 1 / drawn
  double gain = 1.0;   // over the camera's own: fewer electrons reach 255
};

class StereoEye {
 public:
  // name: of the eye in its random streams.
  StereoEye(const nav::CameraCalibration& camera, const PinholeView& view,
            const StereoCameraOptions& options, std::uint64_t seed, std::uint64_t trial,
            const std::string& name);

  [[nodiscard]] const nav::CameraCalibration& camera() const { return camera_; }
  [[nodiscard]] const LensWarp& warp() const { return warp_; }
  [[nodiscard]] const Vignetting& vignetting() const { return vignetting_; }

  // image: behind the lens, CV_8UC1. sun_W: unit vector.
  void Finish(const FrameRequest& request, const PictureExposure& exposure,
              const Eigen::Vector3d& sun_W, cv::Mat& image);

 private:
  nav::CameraCalibration camera_;
  LensWarp warp_;
  Vignetting vignetting_;
  PixelNoise noise_;
  double full_well_e_;
  double read_noise_e_;
  RandomStream noise_stream_;
  RandomStream dirt_stream_;
  LensRain rain_;
  std::optional<LensDirt> dirt_;  // made when first wanted
  std::optional<Glare> glare_;
};

}  // namespace polnav::sim
