#include "nav/ukf/correct.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>

namespace polnav::nav::ukf {
namespace {

using Scalar = Eigen::Matrix<double, 1, 1>;

// A reading of velocity, position and the flow's scale together.
Expected<1> Seen(const State& state) {
  Error h = Error::Zero();
  h(kVelocity) = 1.0;
  h(kPosition) = 0.5;
  h(kFlowScale) = 0.2;
  Expected<1> expected;
  expected.mean.setZero();
  expected.covariance_with_state = state.P * h;
  expected.covariance = h.transpose() * state.P * h;
  return expected;
}

State Unsure() {
  State state;
  state.P = Covariance::Identity();
  state.P(kVelocity, kPosition) = state.P(kPosition, kVelocity) = 0.3;
  return state;
}

// Kalman's own gain makes the innovation's share of the covariance vanish: c c^T / S.
TEST(Correct, TakesAwayWhatTheReadingKnows) {
  State state = Unsure();
  const Expected<1> expected = Seen(state);
  const double s = expected.covariance(0) + 0.1;
  const double before = state.P(kVelocity, kVelocity);
  const Correction done = Correct<1>(expected, Scalar(0.4), Scalar(0.1), 100.0, state);
  ASSERT_TRUE(done.usable);
  const double c = expected.covariance_with_state(kVelocity);
  EXPECT_NEAR(state.P(kVelocity, kVelocity), before - c * c / s, 1e-12);
  EXPECT_NEAR(state.v_WI.x(), c / s * 0.4, 1e-12);
  EXPECT_NEAR(done.nis, 0.4 * 0.4 / s, 1e-12);
}

// Schmidt: what is considered neither moves nor becomes surer, and what is kept does neither.
TEST(Correct, LeavesWhatIsConsideredAndWhatIsKept) {
  State state = Unsure();
  const Expected<1> expected = Seen(state);
  (void)Correct<1>(expected, Scalar(0.4), Scalar(0.1), 100.0, state, {kPosition, 2});
  EXPECT_EQ(state.Slow(kFlowScale), 0.0);
  EXPECT_DOUBLE_EQ(state.P(kFlowScale, kFlowScale), 1.0);
  EXPECT_EQ(state.p_WI.x(), 0.0);
  EXPECT_DOUBLE_EQ(state.P(kPosition, kPosition), 1.0);
  EXPECT_GT(state.v_WI.x(), 0.0);
  EXPECT_TRUE(IsSound(state.P));
  EXPECT_LT((state.P - state.P.transpose()).norm(), 1e-15);
}

TEST(Correct, AReadingBeyondTheGateChangesNothing) {
  State state = Unsure();
  const Covariance before = state.P;
  const Correction done = Correct<1>(Seen(state), Scalar(100.0), Scalar(0.1), 4.0, state);
  EXPECT_TRUE(done.gated);
  EXPECT_EQ(state.P, before);
  EXPECT_EQ(state.v_WI.x(), 0.0);
}

// A covariance that is none: what a reading would make of it is worth nothing, or is repaired and
// said to be.
TEST(Correct, ALostDefinitenessIsReported) {
  State state = Unsure();
  state.P(kVelocity, kVelocity) = -2.0;  // the reading's own variance comes out negative
  const Covariance before = state.P;
  EXPECT_FALSE(Correct<1>(Seen(state), Scalar(0.4), Scalar(0.1), 100.0, state).usable);
  EXPECT_EQ(state.P, before);

  state = Unsure();
  state.P(kGyroBias, kGyroBias) = -1e-3;  // elsewhere
  const Correction done = Correct<1>(Seen(state), Scalar(0.4), Scalar(0.1), 100.0, state);
  EXPECT_TRUE(done.usable);
  EXPECT_TRUE(done.repaired);
  EXPECT_TRUE(IsSound(state.P));
  EXPECT_GE(Eigen::SelfAdjointEigenSolver<Covariance>(state.P).eigenvalues().minCoeff(), -1e-12);
}

TEST(Correct, NoNumberChangesNothing) {
  State state = Unsure();
  const Covariance before = state.P;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(Correct<1>(Seen(state), Scalar(nan), Scalar(0.1), 4.0, state).usable);
  EXPECT_FALSE(Correct<1>(Seen(state), Scalar(0.4), Scalar(nan), 4.0, state).usable);
  EXPECT_EQ(state.P, before);
  EXPECT_EQ(state.v_WI.x(), 0.0);
}

}  // namespace
}  // namespace polnav::nav::ukf
