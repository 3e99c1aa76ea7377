#include "nav/ukf/state.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace polnav::nav::ukf {
namespace {

TEST(UkfState, LogUndoesExp) {
  for (const double angle : {0.0, 1e-9, 1e-3, 0.1, 0.24, 0.26, 1.0, 3.0}) {
    const Eigen::Vector3d theta = angle * Eigen::Vector3d(0.6, -0.48, 0.64);
    EXPECT_LT((Log(Exp(theta)) - theta).norm(), 1e-12) << angle;
    EXPECT_NEAR(Exp(theta).norm(), 1.0, 1e-12) << angle;
  }
}

// The velocity's error turns with the attitude's: seen from the body it does not change by a turn.
TEST(UkfState, ATurnTakesTheVelocityAlong) {
  State state;
  state.v_WI = {0.1, 0.2, 0.0};
  state.P = 1e-4 * Covariance::Identity();
  const Eigen::Vector3d v_I = state.q_WI.conjugate() * state.v_WI;
  Error turn = Error::Zero();
  turn(kTheta + 2) = 0.3;
  Move(turn, state);
  EXPECT_LT((state.q_WI.conjugate() * state.v_WI - v_I).norm(), 1e-12);
}

TEST(UkfState, ALostDefinitenessIsRepaired) {
  Covariance P = Covariance::Identity();
  P(0, 1) = P(1, 0) = 1.5;  // an eigenvalue of -0.5
  ASSERT_TRUE(Repair(P));
  EXPECT_TRUE(IsSound(P));
  EXPECT_GE(Eigen::SelfAdjointEigenSolver<Covariance>(P).eigenvalues().minCoeff(), -1e-12);
  P(3, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(IsSound(P));
  EXPECT_FALSE(Repair(P));
}

}  // namespace
}  // namespace polnav::nav::ukf
