#include "sim/vehicle/chassis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "sim/world/track.h"

namespace polnav::sim {
namespace {

constexpr int kStepsPerSecond = 500;
constexpr TerrainOptions kFlat{
    .slope_deg = 0.0, .camber_deg = 0.0, .undulation_m = 0.0, .bump_m = 0.0};

TerrainOptions Slope(double slope_deg) {
  TerrainOptions options = kFlat;
  options.slope_deg = slope_deg;
  return options;
}

void Drive(Chassis& chassis, const Chassis::Controls& controls, double seconds) {
  const int steps = static_cast<int>(seconds * kStepsPerSecond);
  for (int i = 0; i < steps; ++i) chassis.Step(controls);
}

double TotalLoad(const Chassis& chassis) {
  const auto loads = chassis.WheelLoads_n();
  return std::accumulate(loads.begin(), loads.end(), 0.0);
}

class ChassisTest : public testing::Test {
 protected:
  Track track_{TrackOptions{}};
  Terrain flat_{kFlat, track_, 1};
  CarOptions options_;
};

// The suspension rings down as exp(-0.35 * 9.4 / s * t): after 10 s by exp(-33) = 5e-15.
TEST_F(ChassisTest, SpringsCarryTheWeight) {
  Chassis chassis(options_, flat_, {0.0, 0.0}, 0.3);
  Drive(chassis, {}, 10.0);
  EXPECT_NEAR(TotalLoad(chassis), options_.mass_kg * Chassis::kGravity_m_s2, 1e-6);
  EXPECT_NEAR(chassis.T_WB().p.z(), options_.cg_height_m, 1e-9);
}

// Forces along the ground's normal carry m g cos(slope); the tyres hold the rest.
TEST_F(ChassisTest, BrakedOnASlopeItStaysWhereItIs) {
  for (const double heading : {0.0, 1.0, 2.5}) {
    const Terrain slope(Slope(5.0), track_, 1);
    Chassis chassis(options_, slope, {0.0, 0.0}, heading);
    Drive(chassis, {.brake_n = 6000.0}, 20.0);
    const Eigen::Vector3d early = chassis.T_WB().p;
    const double energy = chassis.MechanicalEnergy_j();
    Drive(chassis, {.brake_n = 6000.0}, 20.0);
    EXPECT_LT((chassis.T_WB().p - early).norm(), 1e-9) << heading;
    EXPECT_LT(chassis.v_WB_m_s().norm(), 1e-9) << heading;
    EXPECT_LE(chassis.MechanicalEnergy_j(), energy + 1e-6) << heading;
    EXPECT_NEAR(TotalLoad(chassis),
                options_.mass_kg * Chassis::kGravity_m_s2 * std::cos(nav::DegToRad(5.0)), 1e-3);
  }
}

// On a slope the springs carry cos(slope) of the weight and stretch by g (1 - cos) / w^2: 1.7 mm,
// of which the lean against the slope, 6e-3 rad squared times half the height, hides 1 %.
TEST_F(ChassisTest, SpringsHaveTheStiffnessOfTheirFrequency) {
  const double slope_rad = nav::DegToRad(10.0);
  const Terrain slope(Slope(10.0), track_, 1);
  Chassis chassis(options_, slope, {0.0, 0.0}, 0.3);
  Drive(chassis, {.brake_n = 6000.0}, 15.0);
  const Eigen::Vector3d p = chassis.T_WB().p;
  const double height = (p.z() - slope.Height(p.x(), p.y())) * std::cos(slope_rad);
  const double w = 2.0 * M_PI * options_.suspension_frequency_hz;
  const double stretch = Chassis::kGravity_m_s2 * (1.0 - std::cos(slope_rad)) / (w * w);
  EXPECT_NEAR((height - options_.cg_height_m) / stretch, 1.0, 0.03);
}

// Energy compared once a second, after the nod of letting go: what a semi-implicit step exchanges
// within a swing (step times frequency of it) is then far below what rolling resistance takes,
// 0.012 m g v = 140 W per m/s.
TEST_F(ChassisTest, RollingWithoutDriveOnlyLosesEnergy) {
  TerrainOptions rough = kFlat;
  rough.undulation_m = 0.1;
  rough.bump_m = 0.007;
  const Terrain bumpy(rough, track_, 3);
  for (const Terrain& terrain : {flat_, bumpy}) {
    Chassis chassis(options_, terrain, {0.0, 0.0}, 0.2);
    Drive(chassis, {.steer_rad = 0.03, .drive_n = 2000.0}, 4.0);
    EXPECT_GT(chassis.v_WB_m_s().norm(), 5.0);
    double last = chassis.MechanicalEnergy_j();
    for (int second = 0; second < 20; ++second) {
      Drive(chassis, {.steer_rad = 0.03}, 1.0);
      const double now = chassis.MechanicalEnergy_j();
      EXPECT_LT(now, last) << second;
      last = now;
    }
  }
}

// Rolling resistance alone: v falls by 0.012 g a second. The tyres' heading is exactly along.
TEST_F(ChassisTest, CoastsDownAtTheRollingResistance) {
  Chassis chassis(options_, flat_, {0.0, 0.0}, 0.0);
  Drive(chassis, {.drive_n = 2000.0}, 4.0);
  Drive(chassis, {}, 3.0);
  const double before = chassis.v_WB_m_s().norm();
  Drive(chassis, {}, 5.0);
  EXPECT_NEAR(before - chassis.v_WB_m_s().norm(), 5.0 * 0.012 * Chassis::kGravity_m_s2, 2e-3);
}

TEST_F(ChassisTest, AcceleratesAsForceOverMass) {
  Chassis chassis(options_, flat_, {0.0, 0.0}, 0.0);
  Drive(chassis, {.drive_n = 2000.0}, 3.0);
  const double before = chassis.v_WB_m_s().norm();
  Drive(chassis, {.drive_n = 2000.0}, 2.0);
  const double expected = 2.0 * (2000.0 / options_.mass_kg - 0.012 * Chassis::kGravity_m_s2);
  EXPECT_NEAR(chassis.v_WB_m_s().norm() - before, expected, 0.01);
}

// At a crawl no slip: radius of the rear axle's circle is wheelbase / tan(steer); B is half a
// wheelbase ahead of it.
TEST_F(ChassisTest, TurnsOnAckermannsCircle) {
  Chassis chassis(options_, flat_, {0.0, 0.0}, 0.0);
  const double steer = 0.2;
  Drive(chassis, {.steer_rad = steer, .drive_n = 600.0}, 3.0);
  Drive(chassis, {.steer_rad = steer, .drive_n = 0.012 * 1200.0 * 9.8}, 3.0);
  const double heading = nav::CompassHeading(chassis.T_WB().q);
  Drive(chassis, {.steer_rad = steer, .drive_n = 0.012 * 1200.0 * 9.8}, 1.0);
  const double rate = -nav::WrapPi(nav::CompassHeading(chassis.T_WB().q) - heading);
  const double radius = std::hypot(options_.wheelbase_m / std::tan(steer), 1.3);
  const double speed = chassis.v_WB_m_s().norm();
  EXPECT_GT(rate, 0.0);  // steering left is turning left
  EXPECT_NEAR(rate / (speed / radius), 1.0, 0.02);
}

TEST_F(ChassisTest, LeansOutOfTheBend) {
  Chassis chassis(options_, flat_, {0.0, 0.0}, 0.0);
  Drive(chassis, {.steer_rad = 0.05, .drive_n = 2000.0}, 4.0);
  const Eigen::Vector3d left_W = chassis.T_WB().q * Eigen::Vector3d::UnitY();
  EXPECT_GT(left_W.z(), nav::DegToRad(0.2));  // turning left, the left side rises
  EXPECT_LT(left_W.z(), nav::DegToRad(2.0));
}

}  // namespace
}  // namespace polnav::sim
