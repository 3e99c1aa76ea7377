#include "nav/ukf/standing.h"

#include <gtest/gtest.h>

#include "nav/inertial/options.h"

namespace polnav::nav::ukf {
namespace {

TEST(Standing, FindsTheGyroscopesBiasAndWhereUpIs) {
  const Eigen::Vector3d bias(0.01, -0.02, 0.015);
  const Eigen::Vector3d up_B = Eigen::Vector3d(0.05, -0.02, 1.0).normalized();
  Standing standing;
  for (int i = 0; i < 100; ++i) {
    // Noise that averages away: it alternates.
    const Eigen::Vector3d noise = (i % 2 == 0 ? 1e-3 : -1e-3) * Eigen::Vector3d(1.0, 1.0, -1.0);
    standing.Add(bias + noise, 1.01 * kGravity_m_s2 * up_B + 10.0 * noise);
  }
  const auto errors = standing.Errors();
  ASSERT_TRUE(errors);
  EXPECT_LT((errors->gyro_bias_rad_s - bias).norm(), 1e-12);
  EXPECT_LT((errors->q_LB * up_B - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_LT((errors->accel_bias_m_s2 - 0.01 * kGravity_m_s2 * up_B).norm(), 1e-9);
}

TEST(Standing, BelievesNoRobotThatMoves) {
  Standing standing;
  for (int i = 0; i < 100; ++i) {
    standing.Add({i % 2 == 0 ? 0.1 : -0.1, 0.0, 0.0}, {0.0, 0.0, kGravity_m_s2});
  }
  EXPECT_FALSE(standing.Errors());
  EXPECT_FALSE(Standing{}.Errors());
}

}  // namespace
}  // namespace polnav::nav::ukf
