#include "sim/disturbances/on_the_road.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/world/actor.h"
#include "tests/sim/world/world_fixture.h"

namespace polnav::sim {
namespace {

const SmallLoop& Loop() {
  static const SmallLoop loop;
  return loop;
}

std::vector<Passer> Passing(const PassingOptions& who, const VehicleOptions& vehicle) {
  DisturbanceOptions entry{.start_s = 20.0, .duration_s = 12.0};
  entry.passing = who;
  return PassersOf(ScheduleDisturbances({entry}, 60.0, 1, 0), vehicle, Loop().track);
}

std::vector<Actor> Actors(const std::vector<Passer>& passers) {
  SceneBuilder builder(32.0, false);
  return MakePassers(passers, Loop().street, 1, AddActorTextures(1, builder));
}

Track::Projection PlaceOf(const Actor& actor, double t_s) {
  return Loop().track.Project(PoseOf(actor.path, nav::FromSeconds(t_s))->p.head<2>());
}

// Three over 12 s: after 2, 6 and 10 s. A car from standstill at 2 s with 6 m/s is nominally at
// 6 m/s * (t - 2 s) then.
TEST(PassersOf, AreAlongsideTheCarAtTimesSpreadOverTheEvent) {
  const std::vector<Passer> passers = Passing({.count = 3, .offset_m = 3.0, .speed_m_s = 9.0},
                                              {.car = CarOptions{.speed_m_s = 6.0}});
  ASSERT_EQ(passers.size(), 3u);
  const std::vector<Actor> actors = Actors(passers);
  for (std::size_t k = 0; k < 3; ++k) {
    const double t_s = 22.0 + 4.0 * static_cast<double>(k);
    EXPECT_NEAR(PlaceOf(actors[k], t_s).s_m, 6.0 * (t_s - 2.0), 0.05);
    EXPECT_NEAR(PlaceOf(actors[k], t_s).offset_m, 3.0, 0.05);
    EXPECT_NEAR(PlaceOf(actors[k], t_s + 2.0).s_m, 6.0 * (t_s - 2.0) + 18.0, 0.05);
  }
}

// 120 m at a difference of 3 m/s take 40 s; what would begin before the run begins with it.
TEST(PassersOf, AreThereFrom120MetresBeforeTo120MetresPast) {
  const Passer passer =
      Passing({.count = 1, .speed_m_s = 9.0}, {.car = CarOptions{.speed_m_s = 6.0}}).front();
  EXPECT_DOUBLE_EQ(passer.begin_s, 0.0);
  EXPECT_DOUBLE_EQ(passer.end_s, 26.0 + 40.0);
  const Passer oncoming =
      Passing({.count = 1, .speed_m_s = -6.0}, {.car = CarOptions{.speed_m_s = 6.0}}).front();
  EXPECT_DOUBLE_EQ(oncoming.begin_s, 26.0 - 10.0);
  const Actor actor = Actors({oncoming}).front();
  EXPECT_FALSE(PoseOf(actor.path, nav::FromSeconds(15.9)));
  EXPECT_TRUE(PoseOf(actor.path, nav::FromSeconds(16.1)));
}

TEST(PassersOf, PassATurntableWhereItStands) {
  const Eigen::Vector2d stand = Loop().track.At(100.0).p_m;
  const TurntableOptions turntable{.position_m = {stand.x(), stand.y(), 1.0}};
  const std::vector<Passer> passers =
      Passing({.kind = "bus", .count = 1, .speed_m_s = 8.0}, {.turntable = turntable});
  EXPECT_NEAR(PlaceOf(Actors(passers).front(), 26.0).s_m, 100.0, 0.05);
}

TEST(PassersOf, NeverComeAtTheVehiclesOwnSpeed) {
  EXPECT_TRUE(Passing({.speed_m_s = 6.0}, {.car = CarOptions{.speed_m_s = 6.0}}).empty());
}

TEST(CloudPassages, StandOverTheCarHalfWay) {
  DisturbanceOptions entry{.start_s = 10.0, .duration_s = 30.0};
  entry.cloud_passage = CloudPassageOptions{.optical_depth = 7.0};
  const auto passages = CloudPassages(ScheduleDisturbances({entry}, 100.0, 1, 0),
                                      {.car = CarOptions{.speed_m_s = 6.0}}, Loop().track);
  ASSERT_EQ(passages.size(), 1U);
  EXPECT_EQ(passages[0].middle_s, 25.0);
  EXPECT_EQ(passages[0].duration_s, 30.0);
  EXPECT_EQ(passages[0].optical_depth, 7.0);
  EXPECT_LT((passages[0].over_m - Loop().track.At(6.0 * 23.0).p_m).norm(), 1e-9);
}

TEST(WithDisturbances, StretchesStandOnTheRoad) {
  DisturbanceOptions walls;
  walls.low_features = StretchOptions{.start_m = 50.0, .length_m = 40.0};
  const WorldOptions world = WithDisturbances({}, {walls}, {}, {}, Loop().track);
  ASSERT_EQ(world.structures.size(), 1u);
  EXPECT_TRUE(IsBare(world.structures, 70.0, Loop().street));
  EXPECT_FALSE(IsBare(world.structures, 95.0, Loop().street));
}

}  // namespace
}  // namespace polnav::sim
