#include "sim/sensors/stereo_eye.h"

namespace polnav::sim {
namespace {

std::array<std::uint32_t, 2> NoiseKey(const RandomStream& stream, std::uint64_t index) {
  RandomStream::Sample random = stream.At(index);
  const std::uint32_t first = random.Bits();
  return {first, random.Bits()};
}

}  // namespace

StereoEye::StereoEye(const nav::CameraCalibration& camera, const PinholeView& view,
                     const StereoCameraOptions& options, std::uint64_t seed, std::uint64_t trial,
                     const std::string& name)
    : camera_(camera),
      warp_(camera, view),
      vignetting_(camera, options.vignetting),
      noise_(options.full_well_e, options.read_noise_e),
      full_well_e_(options.full_well_e),
      read_noise_e_(options.read_noise_e),
      noise_stream_(seed, trial, "stereo/noise/" + name),
      dirt_stream_(seed, trial, "stereo/dirt/" + name),
      rain_(RandomStream(seed, trial, "stereo/rain/" + name)) {}

void StereoEye::Finish(const FrameRequest& request, const PictureExposure& exposure,
                       const Eigen::Vector3d& sun_W, cv::Mat& image) {
  const CameraConditions& now = request.conditions;
  const bool sunny = now.glare > 0.0 && sun_W.z() > 0.0;
  const Eigen::Vector3d sun_C = (request.T_WB.q * camera_.T_BC.q).conjugate() * sun_W;
  double glare = 0.0;
  if (sunny) {
    if (!glare_) glare_.emplace(camera_);
    glare = now.glare * glare_->SunInSight(sun_C, exposure.drawn, image);
  }
  if (now.rain_share > 0.0) rain_.Apply(now.rain_share, request.stamp, image);
  if (now.dirt_share > 0.0) {
    if (!dirt_) dirt_.emplace(image.size(), dirt_stream_);
    dirt_->Apply(now.dirt_share, image);
  }
  if (glare > 0.0) glare_->Apply(glare, sun_C, exposure.drawn, image);
  vignetting_.Apply(image);
  const auto key = NoiseKey(noise_stream_, request.index);
  if (exposure.gain == 1.0) {
    noise_.Add(key, image);
  } else {
    PixelNoise(full_well_e_ / exposure.gain, read_noise_e_).Add(key, image);
  }
}

}  // namespace polnav::sim
