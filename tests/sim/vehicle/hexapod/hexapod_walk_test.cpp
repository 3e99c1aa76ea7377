// Walks that take seconds of computing.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "sim/vehicle/hexapod/hexapod.h"
#include "sim/world/track.h"

namespace polnav::sim {
namespace {

constexpr int kStepsPerSecond = 500;

HexapodOptions Walking(const char* path) {
  HexapodOptions options;
  options.walk.path = path;
  options.walk.start_delay_s = 0.0;
  return options;
}

class HexapodWalk : public testing::Test {
 protected:
  Track track_{TrackOptions{}};
  Terrain plaza_{TerrainOptions{}, track_, 1};
};

// On the plaza's slope. A creep of a micrometre a second would be 60 um.
TEST_F(HexapodWalk, StandsForAMinuteWithoutDrift) {
  Hexapod hexapod(Walking("stand"), plaza_, 1);
  const nav::Pose before = hexapod.truth().T_WB;
  for (int k = 0; k < 60 * kStepsPerSecond; ++k) hexapod.Step();
  EXPECT_LT((hexapod.truth().T_WB.p - before.p).norm(), 1e-4);
  EXPECT_LT(before.q.angularDistance(hexapod.truth().T_WB.q), 1e-4);
}

TEST_F(HexapodWalk, WalksAStraightMetre) {
  HexapodOptions options = Walking("straight");
  options.walk.length_m = 1.0;
  Hexapod hexapod(options, plaza_, 1);
  const nav::Pose start = hexapod.truth().T_WB;
  const double start_energy = hexapod.body().MechanicalEnergy_j();
  double most_energy = start_energy;
  for (int k = 0; k < 20 * kStepsPerSecond; ++k) {
    hexapod.Step();
    most_energy = std::max(most_energy, hexapod.body().MechanicalEnergy_j());
  }
  EXPECT_TRUE(hexapod.finished());
  const Eigen::Vector3d walked_B = start.Inverse() * hexapod.truth().T_WB.p;
  EXPECT_NEAR(walked_B.x(), 1.0, 0.05);
  EXPECT_NEAR(walked_B.y(), 0.0, 0.05);
  // It climbs by at most a few centimetres of the plaza's slope and moves at most at twice its
  // speed: m g h + m v^2 / 2 < 1.5 J.
  EXPECT_LT(most_energy - start_energy, 1.5);
}

TEST_F(HexapodWalk, ClosesASquare) {
  HexapodOptions options = Walking("square");
  options.walk.length_m = 0.6;
  Hexapod hexapod(options, plaza_, 1);
  const nav::Pose start = hexapod.truth().T_WB;
  for (int k = 0; k < 60 * kStepsPerSecond; ++k) hexapod.Step();
  EXPECT_TRUE(hexapod.finished());
  EXPECT_LT((hexapod.truth().T_WB.p - start.p).head<2>().norm(), 0.05);
  const double turned = nav::CompassHeading(hexapod.truth().T_WB.q) - nav::CompassHeading(start.q);
  EXPECT_NEAR(nav::WrapPi(turned), 0.0, nav::DegToRad(5.0));
}

// A shove of 150 N for a fifth of a second throws it off its feet; a nudge of 5 N does not.
TEST_F(HexapodWalk, FallsOverWhenPushedHardEnough) {
  const auto tilt_after = [&](double push_n) {
    Hexapod hexapod(Walking("stand"), plaza_, 1);
    hexapod.Push({0.0, push_n, 0.0});
    for (int k = 0; k < kStepsPerSecond / 5; ++k) hexapod.Step();
    hexapod.Push(Eigen::Vector3d::Zero());
    for (int k = 0; k < 3 * kStepsPerSecond; ++k) hexapod.Step();
    const Eigen::Vector3d up_W = hexapod.truth().T_WB.q * Eigen::Vector3d::UnitZ();
    return nav::RadToDeg(std::acos(up_W.z()));
  };
  EXPECT_LT(tilt_after(5.0), 3.0);
  EXPECT_GT(tilt_after(150.0), 90.0);
}

// Two tripods a cycle: the body heaves at the rate of the steps and its multiples (feet are put
// down and lifted within each). What repeats only with the cycle is how unlike the tripods are;
// between these lines there is next to nothing.
TEST_F(HexapodWalk, StepsShowInTheVerticalAcceleration) {
  HexapodOptions options = Walking("straight");
  options.walk.length_m = 10.0;
  Hexapod hexapod(options, plaza_, 1);
  constexpr double kSpan_s = 8.0;                                // ten cycles
  for (int k = 0; k < 4 * kStepsPerSecond; ++k) hexapod.Step();  // up to speed
  std::vector<double> up_m_s;
  for (int k = 0; k < kSpan_s * kStepsPerSecond; ++k) {
    hexapod.Step();
    up_m_s.push_back(hexapod.truth().v_WB_m_s.z());
  }
  const auto amplitude = [&](double frequency_hz) {
    std::complex<double> sum = 0.0;
    for (std::size_t k = 0; k < up_m_s.size(); ++k) {
      const double phase = 2.0 * std::numbers::pi * frequency_hz * k / kStepsPerSecond;
      sum += up_m_s[k] * std::polar(1.0, -phase);
    }
    return std::abs(sum) * 2.0 / up_m_s.size();
  };
  const double cycle_hz = 1.0 / options.gait.cycle_s;
  const double steps = amplitude(2.0 * cycle_hz);
  EXPECT_GT(steps, 1e-3);
  for (const double between : {1.5, 2.5, 3.5}) {
    EXPECT_LT(amplitude(between * cycle_hz), 0.1 * steps) << between;
  }
  for (const double odd : {1.0, 3.0, 5.0}) {
    EXPECT_LT(amplitude(odd * cycle_hz), 0.5 * steps) << odd;
  }
}

}  // namespace
}  // namespace polnav::sim
