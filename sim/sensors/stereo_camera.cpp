#include "sim/sensors/stereo_camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "sim/random.h"
#include "sim/render/renderer.h"
#include "sim/sensors/lens_warp.h"
#include "sim/sensors/pixel_noise.h"

namespace polnav::sim {
namespace {

constexpr double kFocalShare = 0.75;

std::array<std::uint32_t, 2> NoiseKey(const RandomStream& stream, std::uint64_t index) {
  RandomStream::Sample random = stream.At(index);
  const std::uint32_t first = random.Bits();
  return {first, random.Bits()};
}

// Gain that brings the mean of the clipped, scaled histogram to the target.
double GainFor(const std::array<double, 256>& histogram, double target_mean) {
  double low = 0.01;
  double high = 1000.0;
  for (int i = 0; i < 60; ++i) {
    const double gain = std::sqrt(low * high);
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t grey = 0; grey < histogram.size(); ++grey) {
      sum += histogram[grey] * std::min(255.0, gain * static_cast<double>(grey));
      count += histogram[grey];
    }
    (sum < target_mean * count ? low : high) = gain;
  }
  return std::sqrt(low * high);
}

}  // namespace

struct StereoCamera::Impl {
  struct Side {
    nav::Pose T_BC;
    LensWarp warp;
    RandomStream noise;
  };

  Impl(const Scene& scene, const sky::WorldSky& sky, const nav::StereoCalibration& truth,
       const StereoCameraOptions& options, std::uint64_t seed, std::uint64_t trial)
      : view(CoveringView({truth.left, truth.right}, kFocalShare)),
        renderer(scene, sky, view, UnseenTriangles({truth.left, truth.right}, view)),
        noise(options.full_well_e, options.read_noise_e),
        left{truth.left.T_BC, LensWarp(truth.left, view), {seed, trial, "stereo/noise/left"}},
        right{truth.right.T_BC, LensWarp(truth.right, view), {seed, trial, "stereo/noise/right"}},
        exposure(options.exposure > 0.0 ? options.exposure : FindExposure(options.target_mean)) {}

  // What saturates at one exposure tells nothing about a lower one: search in steps.
  double FindExposure(double target_mean) {
    double found = 0.1;
    for (int step = 0; step < 4; ++step)
      found *= GainFor(HistogramFromTheOrigin(found), target_mean);
    return found;
  }

  std::array<double, 256> HistogramFromTheOrigin(double trial_exposure) {
    std::array<double, 256> histogram{};
    cv::Mat distorted;
    for (int quarter = 0; quarter < 4; ++quarter) {
      const nav::Pose T_WB{nav::LevelAttitude(0.5 * M_PI * quarter), Eigen::Vector3d::Zero()};
      renderer.Render(T_WB * left.T_BC, trial_exposure, pinhole);
      left.warp.Apply(pinhole, distorted);
      for (const std::uint8_t grey : cv::Mat_<std::uint8_t>(distorted)) histogram[grey] += 1.0;
    }
    return histogram;
  }

  cv::Mat CaptureSide(const Side& side, const nav::Pose& T_WB, std::uint64_t index) {
    renderer.Render(T_WB * side.T_BC, exposure, pinhole);
    cv::Mat image;
    side.warp.Apply(pinhole, image);
    noise.Add(NoiseKey(side.noise, index), image);
    return image;
  }

  PinholeView view;
  Renderer renderer;
  PixelNoise noise;
  Side left;
  Side right;
  cv::Mat pinhole;  // reused
  double exposure;
};

StereoCamera::StereoCamera(const Scene& scene, const sky::WorldSky& sky,
                           const nav::StereoCalibration& truth, const StereoCameraOptions& options,
                           std::uint64_t seed, std::uint64_t trial)
    : impl_(std::make_unique<Impl>(scene, sky, truth, options, seed, trial)) {}

StereoCamera::~StereoCamera() = default;

nav::StereoImages StereoCamera::Capture(const nav::Pose& T_WB, nav::TimeNs stamp,
                                        std::uint64_t index) {
  nav::StereoImages images;
  images.stamp = stamp;
  images.left = impl_->CaptureSide(impl_->left, T_WB, index);
  images.right = impl_->CaptureSide(impl_->right, T_WB, index);
  return images;
}

double StereoCamera::exposure() const { return impl_->exposure; }

}  // namespace polnav::sim
