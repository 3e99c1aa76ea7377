// How many optical-flow readings a second, with pictures and without?
#include <benchmark/benchmark.h>

#include "sim/sensors/optical_flow_camera.h"
#include "sim/sensors/optical_flow_model.h"
#include "sim/world/world.h"

namespace polnav::sim {
namespace {

Truth Walking(nav::TimeNs stamp, const Eigen::Vector2d& start_m) {
  Truth truth{.stamp = stamp};
  truth.T_WB.p = {start_m.x() + 0.1 * nav::ToSeconds(stamp), start_m.y(), 0.1};
  return truth;
}

// A minute of them: 3000 readings of 5 displacements each.
void BM_FlowMinuteWithoutPictures(benchmark::State& state) {
  const WorldOptions world;
  const Track track(world.track);
  const Terrain terrain(world.terrain, track, 1);
  const Eigen::Vector2d start_m = track.At(20.0).p_m;
  const OpticalFlowOptions options;
  for (auto _ : state) {
    OpticalFlow flow(options, terrain, nullptr, 1, 0);
    OpticalFlowModel model(options, world.grain_contrast, 1, 0);
    for (nav::TimeNs k = 0; k <= 15000; ++k) {
      if (const auto interval = flow.Look(Walking(k * 4'000'000, start_m))) {
        benchmark::DoNotOptimize(model.Take(*interval));
      }
    }
  }
}
BENCHMARK(BM_FlowMinuteWithoutPictures)->Unit(benchmark::kMillisecond);

void BM_FlowReadingWithPictures(benchmark::State& state) {
  const WorldOptions world;
  const Track track(world.track);
  const Terrain terrain(world.terrain, track, 1);
  const Scene scene = BuildWorld(world, track, terrain, 1, 60.0);
  const sky::WorldSky sky({}, Eigen::Vector3d(-0.7, -0.6, 0.4).normalized(), 1);
  const OpticalFlowOptions options;
  OpticalFlow flow(options, terrain, nullptr, 1, 0);
  OpticalFlowCamera camera(scene, sky, options, world.grain_contrast, 1, 0);
  nav::TimeNs k = 0;
  for (auto _ : state) {
    std::optional<FlowInterval> interval;
    while (!interval) interval = flow.Look(Walking(k++ * 4'000'000, track.At(20.0).p_m));
    benchmark::DoNotOptimize(camera.Take(*interval));
  }
}
BENCHMARK(BM_FlowReadingWithPictures)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace polnav::sim
