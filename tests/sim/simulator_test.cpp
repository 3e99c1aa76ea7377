#include "sim/simulator.h"

#include <gtest/gtest.h>

#include <map>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "sim/measurement_stream.h"

namespace polnav::sim {
namespace {

// A small camera and a bare plaza, so that a few frames are quick.
SimulatorOptions SmallOptions() {
  SimulatorOptions options;
  options.world.plaza = {
      .tree_count = 3, .lamp_count = 3, .parked_car_count = 2, .furniture_count = 3};
  options.world.traffic = {.cars = 4, .pedestrians = 4};
  options.sky.clouds = "few_clouds";
  options.disturbances.resize(2);
  options.disturbances[0].fog = FogOptions{.visibility_m = 80.0};
  options.disturbances[1].mean_interval_s = 0.3;
  options.disturbances[1].duration_s = 0.2;
  options.disturbances[1].rain = LensCoverOptions{.share = 0.3};
  options.sensors.stereo = StereoCameraOptions{.width_px = 160, .height_px = 96, .focal_px = 90.0};
  options.sensors.imu = ImuOptions{};
  options.sensors.polarimeter = PolarimeterOptions{};
  options.sensors.reference = ReferenceOptions{};
  options.sensors.polarization_camera =
      PolarizationCameraOptions{.rate_hz = 2.0, .width_px = 64, .height_px = 48, .focal_px = 40.0};
  return options;
}

// Everything that a stream says, sensor by sensor, as numbers.
using Record = std::map<std::string, std::vector<double>>;

struct Recorder {
  Record& record;

  void Vector(const char* name, const Eigen::Vector3d& v) const {
    record[name].insert(record[name].end(), {v.x(), v.y(), v.z()});
  }
  void operator()(const nav::ImuSample& m) const {
    Vector("imu", m.gyro_rad_s);
    Vector("imu", m.accel_m_s2);
  }
  void operator()(const nav::StereoImages& m) const {
    for (const cv::Mat& image : {m.left, m.right}) {
      for (int row = 0; row < image.rows; ++row) {
        record["stereo"].insert(record["stereo"].end(), image.ptr(row),
                                image.ptr(row) + image.cols);
      }
    }
  }
  void operator()(const nav::PolarizationImage& m) const {
    for (int row = 0; row < m.mosaic.rows; ++row) {
      record["polarization_camera"].insert(record["polarization_camera"].end(),
                                           m.mosaic.ptr<std::uint16_t>(row),
                                           m.mosaic.ptr<std::uint16_t>(row) + m.mosaic.cols);
    }
  }
  void operator()(const nav::PolarizationSample& m) const {
    record["polarimeter"].insert(record["polarimeter"].end(), m.channel.begin(), m.channel.end());
  }
  void operator()(const nav::ReferencePose& m) const {
    Vector("reference", m.T_WB.p);
    Vector("reference", m.v_WB_m_s);
  }
  void operator()(const auto&) const { FAIL() << "no sensor of this simulator says that"; }
};

Record RecordRun(const SimulatorOptions& options, const RunKey& key, double duration_s,
                 int render_threads = 1) {
  Record record;
  nav::TimeNs newest = 0;
  MeasurementStream stream(options, key, nav::FromSeconds(duration_s), render_threads);
  while (const auto item = stream.Next()) {
    if (const auto* truth = std::get_if<Truth>(&*item)) {
      Recorder{record}.Vector("truth", truth->T_WB.p);
      continue;
    }
    if (const auto* seen = std::get_if<FeatureSightings>(&*item)) {
      EXPECT_GE(seen->stamp, newest) << "stamps never go back";
      newest = seen->stamp;
      for (const FeatureSighting& s : seen->sightings) {
        record["features"].insert(record["features"].end(), {s.left_px.x(), s.left_px.y()});
      }
      continue;
    }
    const auto& measurement = std::get<nav::Measurement>(*item);
    EXPECT_GE(nav::StampOf(measurement), newest) << "stamps never go back";
    newest = nav::StampOf(measurement);
    std::visit(Recorder{record}, measurement);
  }
  return record;
}

// What the others are compared with. The suite runs in one process (CMakeLists.txt) and shares it.
const Record& OneSecond() {
  static const Record record = RecordRun(SmallOptions(), {1, 0}, 1.0);
  return record;
}

TEST(Simulator, SamplesEverySensorAtItsRate) {
  const Record& record = OneSecond();
  EXPECT_EQ(record.at("truth").size(), 3U * 11U);
  EXPECT_EQ(record.at("imu").size(), 6U * 100U) << "no mean over an interval before time zero";
  EXPECT_EQ(record.at("polarimeter").size(), 6U * 21U);
  EXPECT_EQ(record.at("reference").size(), 6U * 101U);
  EXPECT_EQ(record.at("stereo").size(), 11U * 2U * 160U * 96U);
  EXPECT_EQ(record.at("polarization_camera").size(), 3U * 64U * 48U);
}

// Pictures give way to sightings, and nothing else is different: not even what the polarimeter and
// the sky camera see of traffic and fog.
TEST(Simulator, MeasurementLevelLeavesAllOtherSensorsAsTheyAre) {
  SimulatorOptions options = SmallOptions();
  options.level = Level::kMeasurement;
  Record record = RecordRun(options, {1, 0}, 1.0);
  EXPECT_GT(record.at("features").size(), 11U * 2U * 50U);
  record.erase("features");
  Record with_pictures = OneSecond();
  with_pictures.erase("stereo");
  EXPECT_EQ(record, with_pictures);
}

TEST(Simulator, MeasurementLevelRepeatsItselfAndDependsOnSeedAndTrial) {
  SimulatorOptions options = SmallOptions();
  options.level = Level::kMeasurement;
  options.sensors.polarization_camera.reset();
  const auto features = [&](const RunKey& key) {
    return RecordRun(options, key, 0.5).at("features");
  };
  const std::vector<double> first = features({1, 0});
  EXPECT_EQ(features({1, 0}), first);
  EXPECT_NE(features({2, 0}), first);
  EXPECT_NE(features({1, 1}), first);
}

TEST(Simulator, SameSeedSameBytesWithOneRenderThreadOrTwo) {
  EXPECT_EQ(OneSecond(), RecordRun(SmallOptions(), {1, 0}, 1.0, 2));
}

// CTest runs the suite in one process; the first run of it is compared with one after another
// scenario, here, and with one in a process of its own in tests/closed_loop.
TEST(Simulator, SameBytesAfterAnotherScenarioRanInTheSameProcess) {
  const Record first = OneSecond();
  SimulatorOptions other = SmallOptions();
  other.sky.clouds = "overcast";
  other.world.traffic = {.cars = 9, .buses = 2};
  other.disturbances.clear();
  EXPECT_NE(first, RecordRun(other, {7, 3}, 0.5));
  EXPECT_EQ(first, RecordRun(SmallOptions(), {1, 0}, 1.0));
}

TEST(Simulator, EverySeedAndTrialIsAnotherRun) {
  SimulatorOptions options = SmallOptions();
  options.sensors.stereo.reset();
  const Record once = RecordRun(options, {1, 0}, 3.0);
  for (const RunKey& other : {RunKey{2, 0}, RunKey{1, 1}}) {
    const Record record = RecordRun(options, other, 3.0);
    for (const char* stream : {"truth", "imu", "polarimeter", "polarization_camera", "reference"}) {
      EXPECT_NE(once.at(stream), record.at(stream)) << stream;
    }
  }
}

TEST(Simulator, LeavingASensorOutLeavesTheOthersAsTheyAre) {
  SimulatorOptions options = SmallOptions();
  options.sensors.imu.reset();
  options.sensors.reference.reset();
  options.sensors.polarization_camera.reset();
  Record rest = OneSecond();
  rest.erase("imu");
  rest.erase("reference");
  rest.erase("polarization_camera");
  EXPECT_EQ(rest, RecordRun(options, {1, 0}, 1.0));
}

// A car on its way through a tunnel from 12 to 22 m, the tail of traffic around it.
SimulatorOptions ThroughATunnel() {
  SimulatorOptions options = SmallOptions();
  options.sensors.stereo.reset();
  options.vehicle.car = CarOptions{.start_delay_s = 0.0};
  options.world.structures = {{.kind = "tunnel", .start_m = 12.0, .length_m = 10.0}};
  options.world.traffic = {.cars = 6, .buses = 2, .pedestrians = 6};
  return options;
}

TEST(Simulator, HidesTheSkyInATunnelAndGivesItBackBitByBit) {
  SimulatorOptions options = ThroughATunnel();
  options.sensors.polarization_camera.reset();
  const Record hidden = RecordRun(options, {1, 0}, 8.0);
  options.world.sky_view = "open";
  const Record open = RecordRun(options, {1, 0}, 8.0);
  EXPECT_EQ(hidden.at("truth"), open.at("truth"));
  int inside = 0;
  int beyond = 0;
  for (std::size_t i = 0; i + 6 <= open.at("polarimeter").size(); i += 12) {  // 20 Hz; truth 10 Hz
    const double north_m = open.at("truth")[i / 12 * 3 + 1];  // the track starts due north
    const bool same =
        std::equal(open.at("polarimeter").begin() + static_cast<std::ptrdiff_t>(i),
                   open.at("polarimeter").begin() + static_cast<std::ptrdiff_t>(i + 6),
                   hidden.at("polarimeter").begin() + static_cast<std::ptrdiff_t>(i));
    if (north_m > 13.0 && north_m < 20.0) {
      ++inside;
      EXPECT_FALSE(same) << north_m;
    } else if (north_m < 11.0 || north_m > 23.5) {
      ++beyond;
      EXPECT_TRUE(same) << north_m;
    }
  }
  EXPECT_GT(inside, 5);
  EXPECT_GT(beyond, 20);
}

// The scene that hides the sky is the same whether cameras need its textures or not.
TEST(Simulator, HidesTheSkyAlikeWithAndWithoutCameras) {
  SimulatorOptions options = ThroughATunnel();
  const Record without = RecordRun(options, {1, 0}, 4.0);
  options.sensors.stereo = SmallOptions().sensors.stereo;
  options.sensors.stereo->rate_hz = 1.0;  // nobody looks at the pictures
  const Record with = RecordRun(options, {1, 0}, 4.0);
  for (const char* stream : {"polarimeter", "polarization_camera"}) {
    EXPECT_EQ(with.at(stream), without.at(stream)) << stream;
  }
}

TEST(Simulator, NobodyNeedsToReadAStreamToItsEnd) {
  MeasurementStream stream(SmallOptions(), {1, 0}, nav::FromSeconds(60.0), 2);
  EXPECT_TRUE(stream.Next());
}

TEST(Simulator, ATurntableCarriesTheSameSensors) {
  SimulatorOptions options = SmallOptions();
  options.sensors.stereo.reset();
  options.vehicle.turntable = TurntableOptions{.dwell_s = 0.5};
  const Record record = RecordRun(options, {1, 0}, 1.0);
  EXPECT_EQ(record.at("imu").size(), 6U * 100U);
  EXPECT_EQ(record.at("polarization_camera").size(), 3U * 64U * 48U);
  options.vehicle.car = CarOptions{};
  EXPECT_THROW(Simulator(options, {1, 0}), std::logic_error) << "two vehicles at once";
}

// Whoever scores the biases that an estimator found has the true ones from the truth.
TEST(Simulator, TheTruthKnowsTheImusBias) {
  SimulatorOptions options;
  options.vehicle.turntable = TurntableOptions{};
  EXPECT_FALSE(std::get<Truth>(Simulator(options, {1, 0}).Step().at(0)).imu_bias.has_value());
  options.sensors.imu = ImuPreset("perfect");
  options.sensors.imu->gyro_bias_deg_s = {1.0, 2.0, 3.0};
  const Truth truth = std::get<Truth>(Simulator(options, {1, 0}).Step().at(0));
  ASSERT_TRUE(truth.imu_bias.has_value());
  EXPECT_LT((truth.imu_bias->gyro_rad_s - nav::DegToRad(1.0) * Eigen::Vector3d(1, 2, 3)).norm(),
            1e-15);
  EXPECT_EQ(truth.imu_bias->accel_m_s2.norm(), 0.0);
}

TEST(Simulator, ARateBetweenPhysicsStepsIsRefused) {
  EXPECT_TRUE(IsSampleRate(20.0));
  EXPECT_FALSE(IsSampleRate(60.0)) << "16.67 ms is no multiple of 2 ms";
  EXPECT_FALSE(IsSampleRate(1000.0));
  SimulatorOptions options = SmallOptions();
  options.sensors.stereo.reset();
  EXPECT_NO_THROW(Simulator(options, {1, 0}));
  options.sensors.imu->rate_hz = 60.0;
  EXPECT_THROW(Simulator(options, {1, 0}), std::logic_error);
}

}  // namespace
}  // namespace polnav::sim
