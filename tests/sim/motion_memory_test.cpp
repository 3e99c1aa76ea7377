#include "sim/motion_memory.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace polnav::sim {
namespace {

constexpr nav::TimeNs kDuration = nav::kNsPerSecond / 2;

SimulatorOptions Options(std::uint64_t world_seed) {
  SimulatorOptions options;
  options.world.seed = world_seed;
  options.vehicle.hexapod.emplace();
  options.vehicle.hexapod->walk.start_delay_s = 0.0;
  options.sensors.imu.emplace();
  options.sensors.polarimeter.emplace();
  return options;
}

std::vector<nav::ImuSample> Readings(Simulator& simulator) {
  std::vector<nav::ImuSample> readings;
  while (simulator.truth().stamp <= kDuration) {
    for (const auto& emission : simulator.Step()) {
      if (const auto* imu = std::get_if<nav::ImuSample>(&emission)) readings.push_back(*imu);
    }
  }
  return readings;
}

TEST(MotionMemory, PlayedBackReadingsAreTheSameBytes) {
  const SimulatorOptions options = Options(7);
  const RunKey key{.seed = 3, .trial = 5};
  MotionMemory memory;
  Simulator simulated(options, key, kDuration);
  Simulator played(options, key, kDuration, memory.For(options, kDuration));
  const auto a = Readings(simulated);
  const auto b = Readings(played);
  ASSERT_EQ(a.size(), 50U);
  ASSERT_EQ(b.size(), a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].accel_m_s2, b[i].accel_m_s2);
    EXPECT_EQ(a[i].gyro_rad_s, b[i].gyro_rad_s);
  }
}

TEST(MotionMemory, IsUsedAgainOnlyWhereNothingDiffers) {
  MotionMemory memory;
  const auto first = memory.For(Options(7), kDuration);
  SimulatorOptions other_sensor = Options(7);
  other_sensor.sensors.imu->gyro_bias_sigma_deg_s = 3.0;
  EXPECT_EQ(memory.For(other_sensor, kDuration), first);
  SimulatorOptions slower = Options(7);
  slower.vehicle.hexapod->walk.speed_m_s = 0.1;
  EXPECT_NE(memory.For(slower, kDuration), first);
  EXPECT_EQ(memory.For(Options(0), kDuration), nullptr) << "each trial has a world of its own";
}

TEST(Playback, RefusesToGoBeyondItsEnd) {
  Playback playback(std::make_shared<const Motion>(2));
  playback.Step();
  EXPECT_THROW(playback.Step(), std::logic_error);
  EXPECT_THROW(Playback(nullptr), std::logic_error);
}

}  // namespace
}  // namespace polnav::sim
