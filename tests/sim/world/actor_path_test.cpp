#include "sim/world/actor_path.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "sim/world/actor.h"
#include "tests/sim/world/world_fixture.h"

namespace polnav::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const SmallLoop& Loop() {
  static const SmallLoop loop;
  return loop;
}

Vector3d PositionAt(const std::vector<ActorKey>& path, double t_s) {
  return PoseOf(path, nav::FromSeconds(t_s))->p;
}

TEST(AlongRoad, IsWhereItShouldBeAtItsInstantAndKeepsToItsLane) {
  const StreetFrame& street = Loop().street;
  const auto path = AlongRoad(street, {.s_m = 100.0,
                                       .at_s = 20.0,
                                       .offset_m = 2.65,
                                       .speed_m_s = -9.0,
                                       .begin_s = 5.0,
                                       .end_s = 60.0});
  EXPECT_FALSE(PoseOf(path, nav::FromSeconds(4.9)));
  EXPECT_LT((PositionAt(path, 20.0) - street.At(100.0, 2.65)).norm(), 5e-3);
  for (double t_s = 5.0; t_s <= 60.0; t_s += 0.37) {
    const auto place = Loop().track.Project(PositionAt(path, t_s).head<2>());
    EXPECT_NEAR(place.offset_m, 2.65, 5e-3);
  }
}

// Forward is where it goes, also against the driving direction, and its wheels are on the ground.
TEST(AlongRoad, LooksWhereItGoesAndLeansWithTheGround) {
  for (const double speed : {7.0, -7.0}) {
    const auto path = AlongRoad(Loop().street, {.offset_m = -2.65, .speed_m_s = speed});
    for (double t_s = 1.0; t_s < 50.0; t_s += 1.3) {
      const nav::Pose pose = *PoseOf(path, nav::FromSeconds(t_s));
      const Vector3d step = PositionAt(path, t_s + 0.01) - PositionAt(path, t_s - 0.01);
      EXPECT_LT((pose.q * Vector3d::UnitX() - step.normalized()).norm(), 0.02);
      // Between keys 1.5 m apart, bumps of 2 to 6 m and 7 mm are cut: they lean by 0.02 at most.
      const Vector3d up = Loop().terrain.Normal(pose.p.x(), pose.p.y());
      EXPECT_LT((pose.q * Vector3d::UnitZ() - up).norm(), 0.02);
      EXPECT_NEAR(pose.p.z(), Loop().terrain.Height(pose.p.x(), pose.p.y()), 0.015);
    }
  }
}

TEST(AlongRoad, DoesNotDependOnWhenItEnds) {
  const auto shorter = AlongRoad(Loop().street, {.end_s = 30.0});
  const auto longer = AlongRoad(Loop().street, {.end_s = 90.0});
  for (double t_s = 0.0; t_s <= 30.0; t_s += 0.1) {
    EXPECT_EQ(PositionAt(shorter, t_s), PositionAt(longer, t_s));
  }
}

TEST(AlongPolyline, GoesStraightBetweenTwoPointsAtItsSpeedAndVanishesAtTheEnd) {
  const auto path = AlongPolyline(
      Loop().street, {.points_m = {{-4.0, 10.0}, {8.0, 15.0}}, .speed_m_s = 1.3, .begin_s = 2.0});
  EXPECT_FALSE(PoseOf(path, nav::FromSeconds(1.99)));
  EXPECT_FALSE(PoseOf(path, nav::FromSeconds(12.01)));  // 13 m at 1.3 m/s
  for (double t_s = 2.0; t_s < 12.0; t_s += 0.25) {
    const Vector2d expected = Vector2d(-4.0, 10.0) + (t_s - 2.0) * 1.3 * Vector2d(12, 5) / 13.0;
    EXPECT_LT((PositionAt(path, t_s).head<2>() - expected).norm(), 1e-6);
  }
  // People stand upright on a slope.
  EXPECT_LT((path[3].T_WA.q * Vector3d::UnitZ() - Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(AlongPolyline, PassesItsPointsAndComesBackInALoop) {
  const std::vector<Vector2d> corners = {{0, 0}, {20, 0}, {20, 20}, {0, 20}};
  const auto path = AlongPolyline(
      Loop().street, {.points_m = corners, .speed_m_s = 5.0, .end_s = 60.0, .loop = true});
  for (const Vector2d& corner : corners) {
    double nearest = 1e9;
    for (double t_s = 0.0; t_s < 20.0; t_s += 0.02) {
      nearest = std::min(nearest, (PositionAt(path, t_s).head<2>() - corner).norm());
    }
    EXPECT_LT(nearest, 0.15);
  }
  for (double t_s = 1.0; t_s < 55.0; t_s += 0.5) {
    const double speed =
        (PositionAt(path, t_s + 0.01) - PositionAt(path, t_s)).head<2>().norm() / 0.01;
    EXPECT_NEAR(speed, 5.0, 0.25);
  }
}

TEST(AlongPolyline, GoesToAndFroBetweenTwoPoints) {
  const auto path = AlongPolyline(
      Loop().street,
      {.points_m = {{5.0, 0.0}, {5.0, 15.0}}, .speed_m_s = 1.5, .end_s = 100.0, .loop = true});
  for (int k = 0; k < 4; ++k) {  // a way takes 10 s
    EXPECT_NEAR(PositionAt(path, 20.0 * k + 5.0).y(), 7.5, 0.01);
    EXPECT_NEAR(PositionAt(path, 20.0 * k + 15.0).y(), 7.5, 0.01);
    EXPECT_LT(PositionAt(path, 20.0 * k + 15.0).y(), PositionAt(path, 20.0 * k + 14.0).y());
  }
}

TEST(CheckPath, RefusesWhatLeadsNowhere) {
  EXPECT_THROW(CheckPath({}), std::invalid_argument);
  EXPECT_THROW(CheckPath({{1.0, 2.0}}), std::invalid_argument);
  EXPECT_THROW(CheckPath({{1.0, 2.0}, {1.0, 2.0}}), std::invalid_argument);
  EXPECT_NO_THROW(CheckPath({{1.0, 2.0}, {1.0, 3.0}}));
}

}  // namespace
}  // namespace polnav::sim
