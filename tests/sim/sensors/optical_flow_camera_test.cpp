// Pictures and model agree: on the motion, and on how wrong they are about it.
#include "sim/sensors/optical_flow_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "sim/measurement_stream.h"
#include "sim/sensors/optical_flow_model.h"
#include "tests/sim/sensors/flow_scene.h"

namespace polnav::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct Plaza {
  LevelGround ground;
  Scene scene = BuildWorld(LevelWorld(), ground.track, ground.terrain, 1, 10.0, true);
  sky::WorldSky sky{sky::SkyOptions{}, Vector3d(-0.7, -0.6, 0.4).normalized(), 1};

  // On the road, by so much to the side.
  [[nodiscard]] nav::Pose On(double height_m, double aside_m) const {
    const Eigen::Vector2d p = ground.track.At(20.0).p_m;
    return {Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Vector3d::UnitZ())),
            {p.x() + aside_m, p.y() + aside_m, height_m}};
  }
};

const Plaza& World() {
  static const Plaza plaza;
  return plaza;
}

std::vector<FlowInterval> Moved(const OpticalFlowOptions& options, const GlideMotion& motion,
                                int count) {
  OpticalFlow flow(options, World().ground.terrain, nullptr, 1, 0);
  return Intervals(flow, motion, count);
}

// Several readings, each against the geometry; px a reading.
struct Errors {
  Vector2d mean = Vector2d::Zero();
  Vector2d sigma = Vector2d::Zero();
  double quality = 0.0;
};

template <typename Sensor>
Errors ErrorsOf(Sensor& sensor, const OpticalFlowOptions& options,
                const std::vector<FlowInterval>& intervals) {
  Errors e;
  Vector2d squares = Vector2d::Zero();
  const double focal_px = DrawTrueFlowCamera(options, 1, 0).focal_px;
  for (const FlowInterval& interval : intervals) {
    const nav::OpticalFlowSample said = sensor.Take(interval);
    Vector2d error = Vector2d(-said.flow_rad.y(), said.flow_rad.x()) * options.focal_px;
    for (std::size_t i = 0; i + 1 < interval.frames.size(); ++i) {
      error -= *TrueShift(interval.frames[i], interval.frames[i + 1], focal_px);
    }
    e.mean += error;
    squares += error.cwiseAbs2();
    e.quality += said.quality;
  }
  const auto n = static_cast<double>(intervals.size());
  e.mean /= n;
  e.quality /= n;
  e.sigma = (squares / n - e.mean.cwiseAbs2()).cwiseSqrt();
  return e;
}

// Five displacements of the picture, each to 0.003 px in the mean: some 0.2 percent of this motion.
TEST(OpticalFlowCamera, SeesTheMotionThatTheGeometryHas) {
  const OpticalFlowOptions options = PerfectFlow();
  OpticalFlowCamera camera(World().scene, World().sky, options, 0.1, 1, 0);
  for (const double height_m : {0.4, 1.0}) {
    for (const GlideMotion& motion :
         {GlideMotion{World().On(height_m, 1.0), {0.5 * height_m, 0.0, 0.0}, {0, 0, 0}},
          GlideMotion{World().On(height_m, 1.0), {0.0, -0.3 * height_m, 0.05}, {0, 0, 0}},
          GlideMotion{World().On(height_m, 1.0), {0, 0, 0}, {0.5, 0.0, 0.2}},
          GlideMotion{World().On(height_m, 1.0), {0.1, 0.1, 0.0}, {0.1, 0.6, 0.0}}}) {
      const Errors e = ErrorsOf(camera, options, Moved(options, motion, 4));
      EXPECT_LT(e.mean.cwiseAbs().maxCoeff(), 0.02) << motion.v_W_m_s.transpose();
      EXPECT_GT(e.quality, 0.9);
    }
  }
}

// The fit's worst cases are 40 percent off (docs/optical_flow.md); 60 readings give sigma to 9.
TEST(OpticalFlowCamera, IsAsNoisyAsTheModelSays) {
  OpticalFlowOptions options = PerfectFlow();
  const OpticalFlowOptions defaults;
  options.full_well_e = defaults.full_well_e;
  options.read_noise_e = defaults.read_noise_e;
  options.model = defaults.model;
  for (const double contrast : {0.1, 0.03}) {
    OpticalFlowCamera camera(World().scene, World().sky, options, contrast, 1, 0);
    for (const double height_m : {0.4, 1.0}) {
      for (const double rate_rad_s : {0.0, 0.2, 0.8}) {
        const GlideMotion motion{World().On(height_m, 1.0),
                                 rate_rad_s * height_m * Vector3d(0.6, 0.8, 0.0)};
        const auto intervals = Moved(options, motion, 60);
        OpticalFlowModel model(options, contrast, 1, 0);
        const Errors drawn = ErrorsOf(camera, options, intervals);
        const Errors modelled = ErrorsOf(model, options, intervals);
        const double ratio = drawn.sigma.norm() / modelled.sigma.norm();
        EXPECT_GT(ratio, 1.0 / 1.8) << contrast << " " << height_m << " " << rate_rad_s;
        EXPECT_LT(ratio, 1.8) << contrast << " " << height_m << " " << rate_rad_s;
        EXPECT_NEAR(drawn.quality, modelled.quality, 0.2)
            << contrast << " " << height_m << " " << rate_rad_s;
      }
    }
  }
}

TEST(OpticalFlowCamera, GivesUpOnGroundWithoutTexture) {
  Scene bare = World().scene;
  for (cv::Mat& texture : bare.textures) texture = cv::Mat(4, 4, CV_8UC1, cv::Scalar(60));
  const OpticalFlowOptions options = PerfectFlow();
  OpticalFlowCamera camera(bare, World().sky, options, 0.0, 1, 0);
  const auto said = camera.Take(Moved(options, {World().On(0.4, 1.0), {0.1, 0, 0}}, 1).front());
  EXPECT_EQ(said.quality, 0.0);
  EXPECT_TRUE(said.flow_rad.isZero());
}

std::vector<nav::OpticalFlowSample> Streamed(int threads, bool with_polarimeter) {
  SimulatorOptions options;
  options.world.plaza = {
      .tree_count = 3, .lamp_count = 3, .parked_car_count = 2, .furniture_count = 3};
  options.sensors.optical_flow = OpticalFlowOptions{};
  if (with_polarimeter) options.sensors.polarimeter = PolarimeterOptions{};
  MeasurementStream stream(options, {1, 0}, nav::FromSeconds(0.5), threads);
  std::vector<nav::OpticalFlowSample> said;
  while (const auto item = stream.Next()) {
    const auto* measurement = std::get_if<nav::Measurement>(&*item);
    if (measurement == nullptr) continue;
    if (const auto* flow = std::get_if<nav::OpticalFlowSample>(measurement)) said.push_back(*flow);
  }
  return said;
}

TEST(OpticalFlowCamera, SaysTheSameWithOneAndTwoRenderThreadsAndAnyOtherSensor) {
  const auto one = Streamed(1, false);
  ASSERT_EQ(one.size(), 25U);
  for (const auto& other : {Streamed(2, false), Streamed(2, true)}) {
    ASSERT_EQ(other.size(), one.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_EQ(other[i].stamp, one[i].stamp);
      EXPECT_EQ(other[i].flow_rad, one[i].flow_rad);
      EXPECT_EQ(other[i].gyro_rad, one[i].gyro_rad);
      EXPECT_EQ(other[i].range_m, one[i].range_m);
      EXPECT_EQ(other[i].quality, one[i].quality);
    }
  }
}

}  // namespace
}  // namespace polnav::sim
