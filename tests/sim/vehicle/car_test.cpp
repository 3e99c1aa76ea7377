#include "sim/vehicle/car.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace polnav::sim {
namespace {

struct Scene {
  explicit Scene(std::uint64_t seed, const CarOptions& options = {.laps = 1})
      : terrain(TerrainOptions{}, track, seed), car(options, track, terrain, seed) {}
  Track track{TrackOptions{}};
  Terrain terrain;
  Car car;
};

double LeanDeg(const Truth& truth, const Eigen::Vector3d& axis_B) {
  return nav::RadToDeg(std::asin((truth.T_WB.q * axis_B).z()));
}

// One lap driven once for all of these.
class LapTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    Scene scene(7);
    record_ = new std::vector<Truth>{scene.car.truth()};
    while (!scene.car.finished()) {
      scene.car.Step();
      record_->push_back(scene.car.truth());
    }
    lap_end_ = record_->size();
    for (int i = 0; i < 20 * 500; ++i) {
      scene.car.Step();
      record_->push_back(scene.car.truth());
    }
  }
  static void TearDownTestSuite() { delete record_; }

  static std::vector<Truth>* record_;
  static std::size_t lap_end_;
};
std::vector<Truth>* LapTest::record_ = nullptr;
std::size_t LapTest::lap_end_ = 0;

TEST_F(LapTest, StampsCountFromZeroInExactSteps) {
  for (std::size_t i = 0; i < record_->size(); ++i) {
    ASSERT_EQ((*record_)[i].stamp, static_cast<nav::TimeNs>(i) * 2'000'000);
  }
}

TEST_F(LapTest, StandsStillAtTheStartHeadingNorth) {
  const Truth& start = record_->front();
  EXPECT_LT(start.T_WB.p.head<2>().norm(), 2e-3);  // tyres give this much on the slope
  EXPECT_LT(std::abs(nav::CompassHeading(start.T_WB.q)), nav::DegToRad(0.1));
  for (int i = 0; i < 2 * 500 - 1; ++i) {
    ASSERT_LT(((*record_)[i].T_WB.p - start.T_WB.p).norm(), 1e-6);
    ASSERT_LT((*record_)[i].w_WB_B_rad_s.norm(), 1e-6);
  }
}

TEST_F(LapTest, KeepsToTheRoadWithinItsWander) {
  const Track track(TrackOptions{});
  double widest = 0.0;
  for (const Truth& truth : *record_) {
    widest = std::max(widest, std::abs(track.Project(truth.T_WB.p.head<2>()).offset_m));
  }
  EXPECT_LT(widest, CarOptions{}.lateral_wander_m + 0.1);
  EXPECT_GT(widest, 0.05);  // it does weave
}

TEST_F(LapTest, ReachesItsSpeedAndHoldsIt) {
  for (std::size_t i = 20 * 500; i < lap_end_; ++i) {
    ASSERT_NEAR((*record_)[i].v_WB_m_s.norm(), CarOptions{}.speed_m_s, 0.3);
  }
  // 377 m at 6 m/s, plus the start delay and about 4 s for getting up to speed.
  EXPECT_NEAR(nav::ToSeconds((*record_)[lap_end_ - 1].stamp), 377.0 / 6.0 + 2.0 + 3.5, 2.0);
}

TEST_F(LapTest, PitchesAndRollsByDegrees) {
  double pitch = 0.0;
  double roll = 0.0;
  for (const Truth& truth : *record_) {
    pitch = std::max(pitch, std::abs(LeanDeg(truth, Eigen::Vector3d::UnitX())));
    roll = std::max(roll, std::abs(LeanDeg(truth, Eigen::Vector3d::UnitY())));
  }
  EXPECT_GT(pitch, 0.5);
  EXPECT_LT(pitch, 3.0);
  EXPECT_GT(roll, 0.5);
  EXPECT_LT(roll, 3.0);
}

TEST_F(LapTest, ComesToRestAfterTheLastLapAndStays) {
  const Truth& end = record_->back();
  const Truth& second_before = (*record_)[record_->size() - 500];
  EXPECT_LT(end.v_WB_m_s.norm(), 1e-6);
  EXPECT_LT((end.T_WB.p - second_before.T_WB.p).norm(), 1e-6);
}

// Central differences over a step h: the trapezoid rule misses h^2 / 4 times the change of
// acceleration, however long the drive: 1e-6 m^2 * 4 m/s^2.
TEST_F(LapTest, VelocityIntegratesToPosition) {
  Eigen::Vector3d p = record_->front().T_WB.p;
  for (std::size_t i = 1; i < record_->size(); ++i) {
    p += 0.5 * 0.002 * ((*record_)[i - 1].v_WB_m_s + (*record_)[i].v_WB_m_s);
    ASSERT_LT((p - (*record_)[i].T_WB.p).norm(), 5e-6);
  }
}

// Rates turn slowly against the step, so that coning is below 1e-9 rad a step: 1e-5 rad in 40 s.
TEST_F(LapTest, AngularVelocityIntegratesToAttitude) {
  Eigen::Quaterniond q = record_->front().T_WB.q;
  for (std::size_t i = 1; i < record_->size(); ++i) {
    const Eigen::Vector3d turn =
        0.5 * 0.002 * ((*record_)[i - 1].w_WB_B_rad_s + (*record_)[i].w_WB_B_rad_s);
    const double angle = turn.norm();
    if (angle > 0.0) q = q * Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle));
    ASSERT_LT(q.angularDistance((*record_)[i].T_WB.q), 1e-5);
  }
}

// No kicks that an accelerometer would show and a road would not: the fastest change is the
// pedals', 2 g a second, 0.039 m/s^2 a step, plus some of the bumps'.
TEST_F(LapTest, AccelerationIsThatOfACarAndChangesSmoothly) {
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i < record_->size(); ++i) {
    const Eigen::Vector3d a = ((*record_)[i].v_WB_m_s - (*record_)[i - 1].v_WB_m_s) / 0.002;
    ASSERT_LT(a.norm(), 3.0) << i;
    ASSERT_LT((a - last).norm(), 0.06) << i;
    last = a;
  }
}

bool SameBytes(const Truth& a, const Truth& b) {
  return a.stamp == b.stamp && a.T_WB.q.coeffs() == b.T_WB.q.coeffs() && a.T_WB.p == b.T_WB.p &&
         a.v_WB_m_s == b.v_WB_m_s && a.w_WB_B_rad_s == b.w_WB_B_rad_s;
}

TEST(Car, RepeatsItselfToTheLastBitForTheSameSeedOnly) {
  Scene first(11);
  Scene second(11);
  Scene other(12);
  for (int i = 0; i < 10 * 500; ++i) {
    first.car.Step();
    second.car.Step();
    other.car.Step();
    ASSERT_TRUE(SameBytes(first.car.truth(), second.car.truth())) << i;
  }
  EXPECT_FALSE(SameBytes(first.car.truth(), other.car.truth()));
}

TEST(Car, FollowsTheCentreLineWhenItDoesNotWander) {
  Scene scene(3, {.lateral_wander_m = 0.0});
  double widest = 0.0;
  for (int i = 0; i < 30 * 500; ++i) {
    scene.car.Step();
    const auto at = scene.track.Project(scene.car.truth().T_WB.p.head<2>());
    widest = std::max(widest, std::abs(at.offset_m));
  }
  EXPECT_LT(widest, 0.1);
}

TEST(Car, DrivesFasterAndSlowerWhenAsked) {
  for (const double speed : {2.0, 12.0}) {
    Scene scene(5, {.speed_m_s = speed});
    for (int i = 0; i < 25 * 500; ++i) scene.car.Step();
    EXPECT_NEAR(scene.car.truth().v_WB_m_s.norm(), speed, 0.3);
    const auto at = scene.track.Project(scene.car.truth().T_WB.p.head<2>());
    EXPECT_LT(std::abs(at.offset_m), 0.8) << speed;
  }
}

}  // namespace
}  // namespace polnav::sim
