#include "sim/sensors/optical_flow_camera.h"

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "sim/render/renderer.h"
#include "sim/sensors/pixel_noise.h"

namespace polnav::sim {
namespace {

constexpr int kSamples = 2;  // along each side of a pixel, whose mean it is

PinholeView ViewOf(int side_px, double focal_px) {
  const double center_px = 0.5 * (side_px - 1);
  return {.width_px = side_px,
          .height_px = side_px,
          .fx_px = focal_px,
          .fy_px = focal_px,
          .cx_px = center_px,
          .cy_px = center_px};
}

}  // namespace

struct OpticalFlowCamera::Impl {
  Impl(const Scene& scene, const sky::WorldSky& sky, const OpticalFlowOptions& options_in,
       double grain_contrast, std::uint64_t seed, std::uint64_t trial)
      : options(options_in),
        renderer(scene, sky,
                 ViewOf(kSamples * options.side_px,
                        kSamples * DrawTrueFlowCamera(options, seed, trial).focal_px),
                 CloseUp{grain_contrast}),
        noise(options.full_well_e, options.read_noise_e),
        noise_stream(seed, trial, "optical_flow/pixels") {}

  const cv::Mat& Draw(const FlowFrame& frame) {
    renderer.RenderRadiance({.T_WC = frame.T_WF, .stamp = frame.stamp, .exposure = 1.0}, drawn);
    cv::resize(drawn, radiance, {options.side_px, options.side_px}, 0.0, 0.0, cv::INTER_AREA);
    return radiance;
  }

  // frame: counted from the scenario's start; its noise is its own, whichever interval it is in.
  cv::Mat Expose(double grey_per_radiance, std::uint64_t frame) {
    cv::Mat picture;
    radiance.convertTo(picture, CV_8U, grey_per_radiance);
    RandomStream::Sample draw = noise_stream.At(frame);
    const std::uint32_t first = draw.Bits();
    noise.Add({first, draw.Bits()}, picture);
    return picture;
  }

  // The first picture's mean decides on all.
  std::vector<cv::Mat> Pictures(const FlowInterval& interval) {
    std::vector<cv::Mat> pictures;
    const std::uint64_t first = interval.index * (interval.frames.size() - 1);
    double grey_per_radiance = 0.0;
    for (const FlowFrame& frame : interval.frames) {
      Draw(frame);
      if (pictures.empty()) {
        const double mean = cv::mean(radiance)[0];
        grey_per_radiance = mean > 1e-9 ? options.target_mean / mean : 0.0;
      }
      pictures.push_back(Expose(grey_per_radiance, first + pictures.size()));
    }
    return pictures;
  }

  OpticalFlowOptions options;
  Renderer renderer;
  PixelNoise noise;
  RandomStream noise_stream;
  // Reused.
  cv::Mat drawn;
  cv::Mat radiance;
};

OpticalFlowCamera::OpticalFlowCamera(const Scene& scene, const sky::WorldSky& sky,
                                     const OpticalFlowOptions& options, double grain_contrast,
                                     std::uint64_t seed, std::uint64_t trial)
    : impl_(std::make_unique<Impl>(scene, sky, options, grain_contrast, seed, trial)) {}

OpticalFlowCamera::~OpticalFlowCamera() = default;

nav::OpticalFlowSample OpticalFlowCamera::Take(const FlowInterval& interval) {
  const std::vector<cv::Mat> pictures = impl_->Pictures(interval);
  std::vector<PictureShift> shifts;
  for (std::size_t i = 0; i + 1 < pictures.size(); ++i) {
    shifts.push_back(MatchBlocks(pictures[i], pictures[i + 1]));
  }
  return Integrate(interval, shifts, impl_->options.focal_px);
}

cv::Mat OpticalFlowCamera::Picture(const FlowInterval& interval, std::size_t frame) {
  return impl_->Pictures(interval).at(frame);
}

}  // namespace polnav::sim
