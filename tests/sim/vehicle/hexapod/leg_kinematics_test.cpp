#include "sim/vehicle/hexapod/leg_kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace polnav::sim {
namespace {

constexpr LegOptions kLeg;

TEST(LegKinematics, AStretchedLegReachesAllItsLinks) {
  const Eigen::Vector3d foot = FootOf(kLeg, Eigen::Vector3d::Zero());
  EXPECT_NEAR(foot.x(), kLeg.coxa_m + kLeg.femur_m + kLeg.tibia_m, 1e-15);
  EXPECT_EQ(foot.tail<2>(), Eigen::Vector2d::Zero());
}

// Over the joints' ranges with the knee above: the same angles come back.
TEST(LegKinematics, AnglesBringTheFootBack) {
  int tried = 0;
  for (double coxa = -1.2; coxa <= 1.2; coxa += 0.4) {
    for (double femur = -0.6; femur <= 0.9; femur += 0.3) {
      for (double tibia = -2.4; tibia <= -0.6; tibia += 0.3) {
        const Eigen::Vector3d angles(coxa, femur, tibia);
        const Eigen::Vector3d foot = FootOf(kLeg, angles);
        // A foot under the body is on the other side of the coxa's axis.
        if (std::hypot(foot.x(), foot.y()) < 1e-3 || std::atan2(foot.y(), foot.x()) * coxa < 0.0) {
          continue;
        }
        const auto found = AnglesFor(kLeg, foot);
        ASSERT_TRUE(found) << angles.transpose();
        EXPECT_LT((*found - angles).norm(), 1e-9) << angles.transpose();
        ++tried;
      }
    }
  }
  EXPECT_GT(tried, 100);
}

TEST(LegKinematics, NothingIsAnsweredOutOfReach) {
  EXPECT_FALSE(AnglesFor(kLeg, {0.3, 0.0, 0.0})) << "too far";
  EXPECT_FALSE(AnglesFor(kLeg, {kLeg.coxa_m, 0.0, -0.01})) << "nearer than the links' difference";
  LegOptions stiff = kLeg;
  stiff.joint_range_deg = 20.0;
  const Eigen::Vector3d sideways(0.09, 0.09, -0.085);
  EXPECT_TRUE(AnglesFor(kLeg, sideways));
  EXPECT_FALSE(AnglesFor(stiff, sideways)) << "beyond the coxa's range";
}

TEST(LegKinematics, RootsAreMirroredAndTripodsAreEverySecondLeg) {
  const auto roots = LegRoots(HexapodOptions{});
  for (int i = 0; i < kLegs; ++i) {
    const Eigen::Vector3d& p = roots[i].p;
    const Eigen::Vector3d& q = roots[kLegs - 1 - i].p;
    EXPECT_EQ(Eigen::Vector3d(p.x(), -p.y(), p.z()), q);
    // A leg points away from the body.
    EXPECT_GT((roots[i].q * Eigen::Vector3d::UnitX()).dot(p), 0.0);
  }
}

}  // namespace
}  // namespace polnav::sim
