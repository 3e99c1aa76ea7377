#include "sim/disturbances/schedule.h"

#include <gtest/gtest.h>

#include <cmath>

namespace polnav::sim {
namespace {

DisturbanceOptions Fog(double start_s, double duration_s, double visibility_m) {
  DisturbanceOptions entry{.start_s = start_s, .duration_s = duration_s};
  entry.fog = FogOptions{.visibility_m = visibility_m};
  return entry;
}

CameraConditions At(const std::vector<DisturbanceOptions>& entries, double t_s) {
  return ConditionsAt(ScheduleDisturbances(entries, 100.0, 1, 0), nav::FromSeconds(t_s));
}

TEST(ScheduleDisturbances, KeepsScriptedTimes) {
  const auto events = ScheduleDisturbances({Fog(5.0, 3.0, 40.0)}, 100.0, 1, 0);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].start_s, 5.0);
  EXPECT_EQ(events[0].end_s, 8.0);
}

TEST(ScheduleDisturbances, LeavesStretchesOfRoadAlone) {
  DisturbanceOptions entry;
  entry.tunnel = StretchOptions{};
  EXPECT_TRUE(ScheduleDisturbances({entry}, 100.0, 1, 0).empty());
}

// 10000 s with one in 20 s on average: 500 +- 22; gaps of an exponential distribution have a
// deviation as large as their mean, known to some 6 percent from 500.
TEST(ScheduleDisturbances, DrawsExponentialGaps) {
  DisturbanceOptions entry = Fog(0.0, 1.0, 40.0);
  entry.mean_interval_s = 20.0;
  const auto events = ScheduleDisturbances({entry}, 1e4, 3, 0);
  EXPECT_NEAR(static_cast<double>(events.size()), 500.0, 70.0);
  double sum = 0.0;
  double square = 0.0;
  for (std::size_t i = 1; i < events.size(); ++i) {
    const double gap = events[i].start_s - events[i - 1].start_s;
    sum += gap;
    square += gap * gap;
  }
  const auto count = static_cast<double>(events.size() - 1);
  const double mean = sum / count;
  EXPECT_NEAR(std::sqrt(square / count - mean * mean) / mean, 1.0, 0.2);
}

TEST(ScheduleDisturbances, RandomTimesDependOnTheKeyAlone) {
  DisturbanceOptions entry = Fog(0.0, 1.0, 40.0);
  entry.mean_interval_s = 10.0;
  const auto alone = ScheduleDisturbances({entry}, 100.0, 1, 0);
  const auto with_another = ScheduleDisturbances({entry, Fog(5.0, 3.0, 40.0)}, 100.0, 1, 0);
  ASSERT_EQ(with_another.size(), alone.size() + 1);
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_EQ(alone[i].start_s, with_another[i].start_s);
  }
  EXPECT_NE(ScheduleDisturbances({entry}, 100.0, 1, 1).front().start_s, alone.front().start_s);
}

TEST(ConditionsAt, AreCleanWithoutADisturbance) {
  const CameraConditions clean = At({Fog(5.0, 3.0, 40.0)}, 4.0);
  EXPECT_EQ(clean.visibility_m, CameraConditions{}.visibility_m);
  EXPECT_EQ(clean.light_share, 1.0);
  EXPECT_EQ(clean.gain_share, 1.0);
}

TEST(ConditionsAt, RiseAndFallOverASecond) {
  const std::vector<DisturbanceOptions> fog = {Fog(5.0, 10.0, 40.0)};
  EXPECT_DOUBLE_EQ(At(fog, 10.0).visibility_m, 40.0);
  EXPECT_DOUBLE_EQ(At(fog, 5.5).visibility_m, 80.0);  // half the extinction
  EXPECT_NEAR(At(fog, 14.5).visibility_m, 80.0, 1e-9);
}

// Extinctions of two fogs add up: of 40 m and 60 m, 1 / (1/40 + 1/60) = 24 m.
TEST(ConditionsAt, AddUpWhereTheyOverlap) {
  EXPECT_NEAR(At({Fog(0.0, 20.0, 40.0), Fog(0.0, 20.0, 60.0)}, 10.0).visibility_m, 24.0, 1e-9);
  DisturbanceOptions rain{.start_s = 0.0, .duration_s = 20.0};
  rain.rain = LensCoverOptions{.share = 0.5};
  EXPECT_DOUBLE_EQ(At({rain, rain}, 10.0).rain_share, 0.75);
}

TEST(ConditionsAt, DarkenByPowers) {
  DisturbanceOptions dark{.start_s = 0.0, .duration_s = 20.0};
  dark.darkness = DarknessOptions{.light_share = 0.01};
  EXPECT_DOUBLE_EQ(At({dark}, 10.0).light_share, 0.01);
  EXPECT_NEAR(At({dark}, 0.5).light_share, 0.1, 1e-12);
}

}  // namespace
}  // namespace polnav::sim
