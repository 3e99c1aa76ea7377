#include "sim/vehicle/hexapod/hexapod.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "sim/world/track.h"

namespace polnav::sim {
namespace {

constexpr TerrainOptions kFlat{
    .slope_deg = 0.0, .camber_deg = 0.0, .undulation_m = 0.0, .bump_m = 0.0};

HexapodOptions Walking(const char* path) {
  HexapodOptions options;
  options.walk.path = path;
  options.walk.start_delay_s = 0.0;
  return options;
}

void Walk(Hexapod& hexapod, double seconds) {
  for (int k = 0; k < static_cast<int>(seconds * 500.0); ++k) hexapod.Step();
}

class HexapodTest : public testing::Test {
 protected:
  Track track_{TrackOptions{}};
  Terrain flat_{kFlat, track_, 1};
};

// Legs give way under the load: by less than their servos' full error turns a link.
TEST_F(HexapodTest, StandsNearItsBodyHeight) {
  const HexapodOptions options = Walking("stand");
  const Hexapod hexapod(options, flat_, 1);
  const double commanded_m = options.gait.body_height_m + options.leg.foot_radius_m;
  const double z_m = hexapod.truth().T_WB.p.z();
  EXPECT_LT(z_m, commanded_m);
  EXPECT_GT(z_m, commanded_m - options.leg.femur_m *
                                   nav::DegToRad(2.0 * options.servo.full_torque_error_deg));
}

TEST_F(HexapodTest, StandsStillAndGainsNoEnergy) {
  Hexapod hexapod(Walking("stand"), flat_, 1);
  const Truth before = hexapod.truth();
  const double energy = hexapod.body().MechanicalEnergy_j();
  Walk(hexapod, 2.0);
  EXPECT_LT((hexapod.truth().T_WB.p - before.T_WB.p).norm(), 1e-5);
  EXPECT_NEAR(hexapod.body().MechanicalEnergy_j(), energy, 1e-4);
}

// In the air nothing but gravity acts on the whole: kinetic energy is what height gave. Servos take
// none while their joints rest where they are wanted; the step of 1 ms loses g v dt / 2 a second.
TEST_F(HexapodTest, FallsAsEnergyHasIt) {
  const HexapodOptions options = Walking("stand");
  const Eigen::Vector3d rest = Eigen::Vector3d(0.0, 0.4, -1.8);
  JointAngles angles;
  angles.fill(rest);
  HexapodBody body(options, flat_, angles);
  // Thrown up with one push.
  for (int k = 0; k < 100; ++k) body.Step(angles, {0.0, 0.0, 100.0});
  const double energy = body.MechanicalEnergy_j();
  const double up_m_s = body.v_WB_m_s().z();
  ASSERT_GT(up_m_s, 2.0);
  for (int k = 0; k < 300; ++k) body.Step(angles);
  EXPECT_LE(body.MechanicalEnergy_j(), energy + 0.01 * body.mass_kg());
}

TEST_F(HexapodTest, SameSeedSameBytes) {
  Hexapod a(Walking("wander"), flat_, 3);
  Hexapod b(Walking("wander"), flat_, 3);
  Hexapod other(Walking("wander"), flat_, 4);
  Walk(a, 1.5);
  Walk(b, 1.5);
  Walk(other, 1.5);
  EXPECT_EQ(a.truth().T_WB.p, b.truth().T_WB.p);
  EXPECT_EQ(a.truth().w_WB_B_rad_s, b.truth().w_WB_B_rad_s);
  EXPECT_NE(a.truth().T_WB.p, other.truth().T_WB.p);
}

TEST_F(HexapodTest, AGaitOutOfReachIsRefused) {
  HexapodOptions options = Walking("straight");
  options.walk.speed_m_s = 1.0;
  EXPECT_THROW(Hexapod(options, flat_, 1), std::logic_error);
}

}  // namespace
}  // namespace polnav::sim
