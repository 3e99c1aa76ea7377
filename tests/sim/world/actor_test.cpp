#include "sim/world/actor.h"

#include <gtest/gtest.h>

#include <cmath>

namespace polnav::sim {
namespace {

constexpr nav::TimeNs kSecond = nav::kNsPerSecond;

// Along a circle of 20 m at 0.2 rad/s, a key every second.
nav::Pose OnCircle(double t_s) {
  const double angle = 0.2 * t_s;
  return {Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ())),
          {20.0 * std::cos(angle), 20.0 * std::sin(angle), 0.0}};
}

std::vector<ActorKey> Circle() {
  std::vector<ActorKey> path;
  for (int i = 0; i <= 10; ++i) path.push_back({i * kSecond, OnCircle(i)});
  return path;
}

TEST(PoseOf, IsNowhereBeforeTheFirstAndAfterTheLastKey) {
  EXPECT_FALSE(PoseOf(Circle(), -1));
  EXPECT_FALSE(PoseOf(Circle(), 10 * kSecond + 1));
  EXPECT_FALSE(PoseOf({}, 0));
  EXPECT_TRUE(PoseOf(Circle(), 0));
  EXPECT_TRUE(PoseOf(Circle(), 10 * kSecond));
}

TEST(PoseOf, MeetsItsKeys) {
  for (int i = 0; i <= 10; ++i) {
    EXPECT_LT((PoseOf(Circle(), i * kSecond)->p - OnCircle(i).p).norm(), 1e-12);
    EXPECT_LT(PoseOf(Circle(), i * kSecond)->q.angularDistance(OnCircle(i).q), 1e-7);
  }
}

// Its slopes are central differences: too slow on a circle by h^2 / 6 of the speed, h = 0.2 rad
// between keys. A cubic with both slopes wrong alike errs along the way by at most 0.096 of that
// times the step: 0.096 * 20 m * 0.2^3 / 6 = 2.6 mm.
TEST(PoseOf, FollowsACircleBetweenItsKeys) {
  for (double t_s = 1.0; t_s < 9.0; t_s += 0.05) {
    const auto pose = PoseOf(Circle(), nav::FromSeconds(t_s));
    EXPECT_LT((pose->p - OnCircle(t_s).p).norm(), 2.7e-3);
    EXPECT_LT(pose->q.angularDistance(OnCircle(t_s).q), 1e-7);
  }
}

TEST(PoseOf, GoesOnSmoothlyAcrossAKey) {
  const auto speed = [](double from_s) {
    const Eigen::Vector3d a = PoseOf(Circle(), nav::FromSeconds(from_s))->p;
    const Eigen::Vector3d b = PoseOf(Circle(), nav::FromSeconds(from_s + 1e-4))->p;
    return Eigen::Vector3d((b - a) / 1e-4);
  };
  EXPECT_LT((speed(4.9999) - speed(5.0)).norm(), 1e-3);
}

}  // namespace
}  // namespace polnav::sim
