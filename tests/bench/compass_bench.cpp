// How long does one heading take?
#include <benchmark/benchmark.h>

#include "nav/polarization/compass.h"
#include "sim/sensors/polarization_camera.h"
#include "sky/sun.h"

namespace polnav {
namespace {

// 1280 x 720 pixels of 8 bits under many clouds, fisheye: every block counts, some saturate.
void BM_CompassFrame(benchmark::State& state) {
  sim::PolarizationCameraOptions camera;
  camera.width_px = 1280;
  camera.height_px = 720;
  camera.bits = 8;
  camera.lens = "equidistant";
  camera.focal_px = 400.0;
  sky::SkyOptions options;
  options.clouds = "many_clouds";
  const Eigen::Vector3d sun_W = sky::DirectionEnu(2.0, 0.6);
  const sky::WorldSky sky(options, sun_W, 3);
  sim::Truth truth;
  truth.T_WB.q = nav::LevelAttitude(0.7);
  const nav::PolarizationImage image = sim::PolarizationCamera(camera, sky, 1, 0).Take(truth, 0);
  const nav::Compass compass({}, sim::NominalPolarizationCamera(camera));
  for (auto _ : state) {
    nav::CompassReading reading = compass.Read(image.mosaic, sun_W);
    benchmark::DoNotOptimize(reading);
  }
}
BENCHMARK(BM_CompassFrame)->Unit(benchmark::kMillisecond)->Repetitions(5)->ReportAggregatesOnly();

}  // namespace
}  // namespace polnav
