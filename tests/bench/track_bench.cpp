// How long does the front end take for a stereo pair?
//
// Four seconds of five_laps' plaza as the simulator draws them, with traffic and noise, played to
// and fro; on one thread. 1226x370 is the shape of KITTI's pictures, with its focal length and
// baseline.
#include <benchmark/benchmark.h>

#include <opencv2/core.hpp>
#include <vector>

#include "nav/stereo/tracker.h"
#include "sim/simulator.h"

namespace polnav::sim {
namespace {

struct Drive {
  nav::StereoCalibration calibration;
  std::vector<nav::StereoImages> pairs;
};

Drive Render(const StereoCameraOptions& camera_options) {
  SimulatorOptions options;
  options.site = {.latitude_deg = 38.832,
                  .longitude_deg = 121.503,
                  .altitude_m = 20.0,
                  .utc = "2020-11-11T07:00:00Z"};
  options.world.terrain = {.slope_deg = 1.0, .camber_deg = 1.5};
  options.world.traffic = {.cars = 6, .pedestrians = 24, .speed_m_s = 7.5};
  options.sensors.stereo = camera_options;
  Simulator simulator(options, {});
  StereoCamera camera(simulator.scene(), simulator.sky(), *simulator.true_stereo(), camera_options,
                      1, 0);
  Drive drive{.calibration = *simulator.true_stereo(), .pairs = {}};
  while (simulator.truth().stamp < nav::FromSeconds(24.0)) {
    for (const Simulator::Emission& emission : simulator.Step()) {
      const auto* frame = std::get_if<FrameRequest>(&emission);
      if (frame == nullptr || frame->stamp < nav::FromSeconds(20.0)) continue;
      drive.pairs.push_back(camera.Capture(*frame));
    }
  }
  return drive;
}

// 0 1 2 ... n-1 n-2 ... 1 0 1 ...
std::size_t ToAndFro(std::size_t i, std::size_t count) {
  const std::size_t place = i % (2 * count - 2);
  return place < count ? place : 2 * count - 2 - place;
}

void BM_TrackFrame(benchmark::State& state, const StereoCameraOptions& camera) {
  cv::setNumThreads(1);
  const Drive drive = Render(camera);
  nav::StereoTracker tracker({}, drive.calibration);
  std::size_t next = 0;
  for (auto _ : state) {
    nav::StereoImages pair = drive.pairs[ToAndFro(next, drive.pairs.size())];
    pair.stamp = static_cast<nav::TimeNs>(next++);
    benchmark::DoNotOptimize(tracker.Track(pair));
  }
}
BENCHMARK_CAPTURE(BM_TrackFrame, 672x376, StereoCameraOptions{})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_TrackFrame, 1226x370,
                  StereoCameraOptions{
                      .width_px = 1226, .height_px = 370, .focal_px = 707.0, .baseline_m = 0.537})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace polnav::sim
