#include "sim/sensors/auto_exposure.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>

#include "sim/render/renderer.h"
#include "sim/sensors/glare.h"
#include "sim/sensors/lens_warp.h"
#include "sim/sensors/vignetting.h"

namespace polnav::sim {
namespace {

constexpr int kWidth_px = 48;
constexpr double kLeast = 0.005;
constexpr double kMost = 20.0;
constexpr double kRatioMax = 8.0;  // of one look: black or white says no more
constexpr int kLooksAtStart = 12;

// The same field on fewer pixels.
nav::CameraCalibration Shrunk(nav::CameraCalibration camera) {
  const double scale = static_cast<double>(kWidth_px) / camera.width_px;
  const double height = std::max(2.0, std::round(scale * camera.height_px));
  camera.width_px = kWidth_px;
  camera.height_px = static_cast<int>(height);
  camera.fx_px *= scale;
  camera.fy_px *= scale;
  // A pixel's corner, not its centre, stays at the picture's corner.
  camera.cx_px = scale * (camera.cx_px + 0.5) - 0.5;
  camera.cy_px = scale * (camera.cy_px + 0.5) - 0.5;
  return camera;
}

}  // namespace

struct AutoExposure::Impl {
  Impl(const Scene& scene, const sky::WorldSky& sky, const nav::CameraCalibration& left,
       const StereoCameraOptions& options)
      : camera(Shrunk(left)),
        view(CoveringView({camera}, 1.0)),
        renderer(scene, sky, view),
        warp(camera, view),
        glare(camera),
        vignetting(camera, options.vignetting),
        sun_W(sky.sun_W()),
        target_mean(options.target_mean),
        time_constant_s(options.auto_exposure_time_constant_s) {}

  // By how much the mean grey falls short of the target.
  double Shortfall(const FrameRequest& request, double with_exposure) {
    const double lit = with_exposure * request.conditions.light_share / vignetting.headroom();
    const nav::Pose T_WC = request.T_WB * camera.T_BC;
    renderer.Render({.T_WC = T_WC,
                     .stamp = request.stamp,
                     .exposure = lit,
                     .visibility_m = request.conditions.visibility_m},
                    pinhole);
    warp.Apply(pinhole, image);
    if (request.conditions.glare > 0.0 && sun_W.z() > 0.0) {
      const Eigen::Vector3d sun_C = T_WC.q.conjugate() * sun_W;
      const double in_sight = glare.SunInSight(sun_C, lit, image);
      glare.Apply(in_sight * request.conditions.glare, sun_C, lit, image);
    }
    vignetting.Apply(image);
    const double mean = cv::mean(image)[0];
    return std::clamp(target_mean / std::max(mean, 1e-3), 1.0 / kRatioMax, kRatioMax);
  }

  nav::CameraCalibration camera;
  PinholeView view;
  Renderer renderer;
  LensWarp warp;
  Glare glare;
  Vignetting vignetting;
  Eigen::Vector3d sun_W;  // where the renderer draws it: at the start
  double target_mean;
  double time_constant_s;
  std::optional<double> exposure;
  nav::TimeNs last_stamp = 0;
  double last_shortfall = 1.0;
  cv::Mat pinhole;  // reused
  cv::Mat image;
};

AutoExposure::AutoExposure(const Scene& scene, const sky::WorldSky& sky,
                           const nav::CameraCalibration& left, const StereoCameraOptions& options)
    : impl_(std::make_unique<Impl>(scene, sky, left, options)) {}

AutoExposure::~AutoExposure() = default;

double AutoExposure::Next(const FrameRequest& request) {
  Impl& m = *impl_;
  const auto bounded = [](double exposure) { return std::clamp(exposure, kLeast, kMost); };
  if (!m.exposure) {
    m.exposure = 0.1;
    for (int i = 0; i < kLooksAtStart; ++i) {
      m.exposure = bounded(*m.exposure * m.Shortfall(request, *m.exposure));
    }
  } else {
    const double dt_s = nav::ToSeconds(request.stamp - m.last_stamp);
    const double share = 1.0 - std::exp(-dt_s / m.time_constant_s);
    m.exposure = bounded(*m.exposure * std::pow(m.last_shortfall, share));
  }
  m.last_stamp = request.stamp;
  m.last_shortfall = m.Shortfall(request, *m.exposure);
  return *m.exposure;
}

}  // namespace polnav::sim
