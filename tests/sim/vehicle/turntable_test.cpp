#include "sim/vehicle/turntable.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sim/sensors/rotation.h"
#include "sim/world/track.h"

namespace polnav::sim {
namespace {

constexpr nav::TimeNs kStep = 2'000'000;

std::vector<Truth> Turn(const TurntableOptions& options, double duration_s,
                        std::uint64_t seed = 1) {
  const Track track{TrackOptions{}};
  const Terrain terrain(TerrainOptions{}, track, 3);
  Turntable table(options, terrain, seed);
  std::vector<Truth> truth{table.truth()};
  while (table.truth().stamp < nav::FromSeconds(duration_s)) {
    table.Step(kStep);
    truth.push_back(table.truth());
  }
  return truth;
}

const Truth& At(const std::vector<Truth>& truth, double t_s) {
  return truth[static_cast<std::size_t>(nav::FromSeconds(t_s) / kStep)];
}

// [Chu2021, experiment A]: 0 to 180 degrees, then -180 to 0, with a stop of 30 s at every 90.
// A step takes 2 90 / 10 = 18 s.
TEST(Turntable, StopsForHalfAMinuteAtEveryNinetyDegrees) {
  const std::vector<Truth> truth = Turn({.tilt_sigma_deg = 0.0}, 200.0);
  for (int stop = 0; stop < 4; ++stop) {
    for (const double within_s : {0.0, 15.0, 29.9}) {
      const Truth& t = At(truth, 48.0 * stop + within_s);
      EXPECT_NEAR(nav::WrapPi(nav::CompassHeading(t.T_WB.q) - nav::DegToRad(90.0 * stop)), 0.0,
                  1e-12);
      EXPECT_EQ(t.w_WB_B_rad_s.norm(), 0.0);
    }
  }
}

TEST(Turntable, TurnsClockwiseAndFastestHalfWay) {
  const std::vector<Truth> truth = Turn({.tilt_sigma_deg = 0.0}, 48.0);
  const Truth& half_way = At(truth, 39.0);
  EXPECT_NEAR(nav::RadToDeg(nav::CompassHeading(half_way.T_WB.q)), 45.0, 1e-9);
  EXPECT_NEAR(nav::RadToDeg(half_way.w_WB_B_rad_s.z()), -10.0, 1e-9);
}

// Central differences err by the third derivative: rate (2 pi / T)^2 step^2 / 6, 1e-9 rad/s.
TEST(Turntable, RateIsTheDerivativeOfAttitude) {
  const std::vector<Truth> truth = Turn({.tilt_sigma_deg = 2.0}, 60.0);
  for (std::size_t i = 1; i + 1 < truth.size(); ++i) {
    const Eigen::Vector3d rate =
        RotationVector(truth[i - 1].T_WB.q.conjugate() * truth[i + 1].T_WB.q) / 0.004;
    ASSERT_LT((rate - truth[i].w_WB_B_rad_s).norm(), 1e-7) << i;
  }
}

TEST(Turntable, ItsAxisLeansAndStays) {
  const std::vector<Truth> truth = Turn({.tilt_sigma_deg = 2.0}, 60.0);
  const Eigen::Vector3d axis_W = truth.front().T_WB.q * Eigen::Vector3d::UnitZ();
  EXPECT_LT(axis_W.z(), 1.0 - 1e-6);
  for (const Truth& t : truth) {
    ASSERT_LT((t.T_WB.q * Eigen::Vector3d::UnitZ() - axis_W).norm(), 1e-12);
    ASSERT_EQ(t.T_WB.p, truth.front().T_WB.p);
  }
  const std::vector<Truth> other = Turn({.tilt_sigma_deg = 2.0}, 0.0, 2);
  EXPECT_GT((other.front().T_WB.q * Eigen::Vector3d::UnitZ() - axis_W).norm(), 1e-6);
}

TEST(Turntable, WithoutStepsItStands) {
  for (const Truth& t : Turn({.step_deg = 0.0, .dwell_s = 0.0}, 1.0)) {
    ASSERT_EQ(t.w_WB_B_rad_s.norm(), 0.0);
    ASSERT_TRUE(t.T_WB.q.coeffs().allFinite());
  }
}

}  // namespace
}  // namespace polnav::sim
