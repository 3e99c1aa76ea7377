#include "sim/sensors/stereo_camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "sim/render/renderer.h"
#include "sim/sensors/lens_warp.h"
#include "sim/sensors/shutter.h"
#include "sim/sensors/stereo_eye.h"
#include "sim/sensors/truth_raster.h"

namespace polnav::sim {
namespace {

constexpr double kFocalShare = 0.75;

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
  Impl(const Scene& scene, const sky::WorldSky& sky, const nav::StereoCalibration& cameras,
       const StereoCameraOptions& options, std::uint64_t seed, std::uint64_t trial)
      : view(CoveringView({cameras.left, cameras.right}, kFocalShare)),
        renderer(scene, sky, view, UnseenTriangles({cameras.left, cameras.right}, view)),
        sun_W(sky.sun_W()),
        shutter(options.exposure_time_s, options.rolling_shutter_s, options.focal_px),
        left(cameras.left, view, options, seed, trial, "left"),
        right(cameras.right, view, options, seed, trial, "right"),
        exposure(options.exposure > 0.0 ? options.exposure : FindExposure(options.target_mean)) {
    if (!options.ground_truth) return;
    truth.emplace(scene, cameras.left);
    for (const Actor& actor : scene.actors) actors.push_back({.path = actor.path});
  }

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
      renderer.Render({.T_WC = T_WB * left.camera().T_BC,
                       .exposure = trial_exposure / left.vignetting().headroom()},
                      pinhole);
      left.warp().Apply(pinhole, distorted);
      left.vignetting().Apply(distorted);
      for (const std::uint8_t grey : cv::Mat_<std::uint8_t>(distorted)) histogram[grey] += 1.0;
    }
    return histogram;
  }

  [[nodiscard]] PictureExposure ExposureFor(const FrameRequest& request,
                                            const StereoEye& eye) const {
    const double asked = request.exposure > 0.0 ? request.exposure : exposure;
    const double set = asked * request.conditions.gain_share;
    // Less light than the camera's own exposure would take is a shorter one, not a lower gain.
    return {.drawn = set * request.conditions.light_share / eye.vignetting().headroom(),
            .gain = std::max(1.0, set / exposure)};
  }

  void Draw(const SubFrame& at, const StereoEye& eye, double drawn, double visibility_m) {
    renderer.Render({.T_WC = at.T_WB * eye.camera().T_BC,
                     .stamp = at.stamp,
                     .exposure = drawn,
                     .visibility_m = visibility_m},
                    pinhole);
  }

  // The mean over the exposure, behind the lens.
  void Expose(const FrameRequest& request, const StereoEye& eye, double drawn, cv::Mat& image) {
    const std::vector<SubFrame> sub_frames = shutter.SubFramesOf(request);
    const int count = static_cast<int>(sub_frames.size());
    const int rows = eye.camera().height_px;
    image.create(rows, eye.camera().width_px, CV_8UC1);
    cv::Mat sum(image.size(), CV_32FC1, cv::Scalar(0.0));
    for (int i = 0; i < count; ++i) {
      cv::Range open(rows, 0);
      for (int row = 0; row < rows; ++row) {
        if (shutter.Share(row, rows, i, count) == 0.0) continue;
        open = {std::min(open.start, row), row + 1};
      }
      if (open.start >= open.end) continue;
      Draw(sub_frames[static_cast<std::size_t>(i)], eye, drawn, request.conditions.visibility_m);
      eye.warp().ApplyToRows(pinhole, open, image);
      for (int row = open.start; row < open.end; ++row) {
        const auto share = static_cast<float>(shutter.Share(row, rows, i, count));
        const auto* const grey = image.ptr<std::uint8_t>(row);
        auto* const total = sum.ptr<float>(row);
        for (int col = 0; col < image.cols; ++col) total[col] += share * grey[col];
      }
    }
    sum.convertTo(image, CV_8U);
  }

  cv::Mat CaptureSide(const FrameRequest& request, StereoEye& eye) {
    const PictureExposure light = ExposureFor(request, eye);
    cv::Mat image;
    if (shutter.IsInstant()) {
      Draw({request.stamp, request.T_WB}, eye, light.drawn, request.conditions.visibility_m);
      eye.warp().Apply(pinhole, image);
    } else {
      Expose(request, eye, light.drawn, image);
    }
    eye.Finish(request, light, sun_W, image);
    return image;
  }

  PinholeView view;
  Renderer renderer;
  Eigen::Vector3d sun_W;  // where the renderer draws it: at the start
  Shutter shutter;
  StereoEye left;
  StereoEye right;
  cv::Mat pinhole;  // reused
  double exposure;
  // With ground_truth only.
  std::optional<TruthRaster> truth;
  std::vector<Actor> actors;  // their paths
};

StereoCamera::StereoCamera(const Scene& scene, const sky::WorldSky& sky,
                           const nav::StereoCalibration& truth, const StereoCameraOptions& options,
                           std::uint64_t seed, std::uint64_t trial)
    : impl_(std::make_unique<Impl>(scene, sky, truth, options, seed, trial)) {}

StereoCamera::~StereoCamera() = default;

nav::StereoImages StereoCamera::Capture(const FrameRequest& request) {
  nav::StereoImages images;
  images.stamp = request.stamp;
  images.left = impl_->CaptureSide(request, impl_->left);
  images.right = impl_->CaptureSide(request, impl_->right);
  return images;
}

FrameTruth StereoCamera::CaptureTruth(const FrameTruthRequest& request) {
  if (!impl_->truth) throw std::logic_error("StereoCamera: made without ground_truth");
  const nav::CameraCalibration& left = impl_->left.camera();
  const TruthLayers now = impl_->truth->Draw(request.frame.T_WB * left.T_BC, request.frame.stamp);
  const TruthLayers next = impl_->truth->Draw(request.next_T_WB * left.T_BC, request.next_stamp);
  return MakeFrameTruth(left, now, next, request, impl_->actors);
}

double StereoCamera::exposure() const { return impl_->exposure; }

}  // namespace polnav::sim
